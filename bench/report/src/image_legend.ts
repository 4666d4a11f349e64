// What the colours of an image mean, and which keys it listens to.
import { categorical, css, gradient, kNoProbe, type Colour } from "./colour_maps";
import { h } from "./dom";
import type { Layer } from "./image_layers";
import { kNoNumber, type ReportImage } from "./report_image";

/** A colour beside what it stands for. */
export function swatch(colour: Colour, text: string): HTMLElement {
    return h("span", { class: "swatch" }, h("i", { style: `background: ${css(colour)}` }), text);
}

/** What the colours mean. @param top  the number where they end    @param errors  whether an error is among what is shown */
export function legendOf(layer: Layer, images: ReportImage[], top: number, errors: boolean): Node[] {
    const bar = (low: string, high: string): HTMLElement =>
        h(
            "div",
            {},
            h("div", { class: "bar", style: `background: ${gradient()}` }),
            h("div", { class: "ends" }, h("span", {}, low), h("span", {}, high)),
        );
    const parts: Node[] = [];
    if (errors)
        parts.push(
            h("h4", {}, "Error"),
            bar("0", "1 and more"),
            h("p", { class: "note" }, "√ of (a − b)² / (b² + 0.01), mean of the channels; b the reference."),
        );
    if (layer.key === "probe" && images.length > 0) {
        const used = [...new Set(images.flatMap((image) => Array.from(image.numbers ?? [])))]
            .filter((value) => value !== kNoNumber)
            .sort((a, b) => a - b);
        parts.push(
            h("h4", {}, `Probe that answered (${used.length} in view)`),
            h(
                "div",
                { class: "swatches" },
                ...used.slice(0, 40).map((index) => swatch(categorical(index), String(index))),
                swatch(kNoProbe, "none"),
                used.length > 40 ? "…" : "",
            ),
        );
    } else if (!layer.colours && images.length > 0)
        parts.push(h("h4", {}, `${layer.label} a pixel`), bar("0", `${top} and more`), swatch(kNoProbe, "no ray"));
    return parts;
}

/** The keys that the images listen to. */
export function keysHelp(): HTMLElement {
    return h(
        "details",
        { class: "keys" },
        h("summary", {}, "Keys"),
        h(
            "dl",
            {},
            ...[
                ["1–9", "left image"],
                ["Shift 1–9", "right image"],
                ["E, Shift E", "error of the left, right image"],
                ["X", "swap left and right"],
                ["L", "next layer"],
                ["V", "divider or all"],
                ["[ and ]", "darker, brighter"],
                ["+ and -", "zoom"],
                ["0", "whole image"],
                ["arrows", "pixel by pixel; the divider when it has the focus"],
                ["Shift arrows", "move the image"],
            ].flatMap(([key, what]) => [h("dt", {}, h("kbd", {}, key ?? "")), h("dd", {}, what ?? "")]),
        ),
    );
}
