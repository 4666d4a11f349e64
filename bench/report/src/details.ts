// Everything that is known of one point.
import { h } from "./dom";
import { figures, withUnit } from "./figures";
import { number, plain } from "./format";
import { glyph, titleOf, type MethodStyle } from "./methods";
import { gridShape, imagesOf, isNumber, type Scene } from "./results";
import type { Store } from "./store";

function block(title: string, rows: [string, string][]): HTMLElement | null {
    if (rows.length === 0) return null;
    const list = h("dl", {});
    for (const [name, value] of rows) list.append(h("dt", { title: name }, name), h("dd", { title: value }, value));
    return h("div", {}, h("h4", {}, title), list);
}

/** A box that shows the point that was picked, and follows the choice. */
export function details(scene: Scene, styles: Map<string, MethodStyle>, store: Store): HTMLElement {
    const box = h("div", { class: "details", "aria-live": "polite" });
    const update = (): void => {
        const point = store.picked;
        if (!point) {
            box.replaceChildren(h("p", { class: "note" }, "Click a point (or press Enter on it) to see all that was measured of it."));
            return;
        }
        const group = (name: string): [string, string][] =>
            figures.filter((of) => of.group === name && of.of(point) !== null).map((of) => [of.short, withUnit(of, of.of(point))]);
        const passes = Object.entries(point.passes_ms ?? {}).flatMap(([name, value]): [string, string][] => {
            const time = isNumber(value) ? value : (value as { median?: unknown } | null)?.median;
            return isNumber(time) ? [[name, `${number(time)} ms`]] : [];
        });
        const settings = Object.entries(point.settings ?? {}).map(([name, value]): [string, string] => [name, plain(value)]);
        const shape = gridShape(scene.probe_sets?.[point.probe_set ?? ""]);
        if (shape) settings.push(["grid", shape]);
        box.replaceChildren(
            h(
                "div",
                { class: "details-head" },
                glyph(styles.get(point.method)),
                h("h3", {}, titleOf(point)),
                h("code", { class: "clip", title: point.id }, point.id),
                point.clock === "cpu" ? h("span", { class: "note" }, "times of the CPU") : null,
                Object.keys(imagesOf(point)).length > 0
                    ? h("button", { type: "button", click: () => store.show(point) }, "Show its images")
                    : h("span", { class: "note" }, "no images kept"),
                h("button", { type: "button", class: "quiet", click: () => store.pick(null) }, "Close"),
            ),
            point.wrong ? h("p", { class: "wrong" }, `Wrong: ${point.wrong}`) : "",
            h(
                "div",
                { class: "details-body" },
                ...[
                    block("Settings", settings),
                    block("Time", group("time")),
                    block("Passes", passes),
                    block("Rays", group("rays")),
                    block("Error", group("error")),
                    block("Memory", group("memory")),
                ].filter((part): part is HTMLElement => part !== null),
            ),
        );
    };
    store.on(["pick"], update);
    update();
    return box;
}
