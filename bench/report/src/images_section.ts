// Ours, the baseline, the reference and their errors: beside each other with a divider, or all at once, at one place and exposure.
import { onDrag } from "./drag";
import { h, perFrame, section, segments, toggle, type Segments } from "./dom";
import { number } from "./format";
import {
    entriesOf,
    kLayers,
    load,
    paint,
    pixelText,
    sharedExposure,
    toneTable,
    topOf,
    type Entry,
    type Layer,
    type Loaded,
} from "./image_layers";
import { keysHelp, legendOf } from "./image_legend";
import { imagePane, type Pane, type View } from "./image_pane";
import type { ReportImage } from "./report_image";
import type { Scene } from "./results";
import type { Store } from "./store";

const kStops = 8; // the exposure can be changed by, up and down
const kZoomMost = 64;

export function imagesSection(scene: Scene, store: Store): HTMLElement {
    const entries = entriesOf(scene);
    const layers = kLayers.filter((layer) => entries.some((entry) => entry.images[layer.key]));
    const [width, height] = [scene.width ?? 0, scene.height ?? 0];
    if (entries.length === 0 || layers.length === 0 || !(width > 0 && height > 0))
        return section("images", "Images", h("p", { class: "note" }, "This scene has no images."));

    const truth = entries.find((entry) => !entry.point);
    let layer = layers[0] as Layer;
    let left = 0;
    let right = truth ? entries.indexOf(truth) : Math.min(1, entries.length - 1);
    let stops = 0;
    let auto = 1;
    let errors = { left: false, right: false }; // whether the error is shown in place of the image
    let split = 0.5;
    let all = false;
    let cursor: [number, number] | null = null;
    let view: View = { zoom: 0, x: width / 2, y: height / 2 };
    let shown: { loaded: Loaded; canvas: HTMLCanvasElement | null }[] = [];
    let panes: Pane[] = [];

    // The parts of the page.
    const keyOf = (index: number): string | undefined => (index < 9 ? String(index + 1) : undefined);
    const choices = entries.map((entry, index) => ({ value: String(index), label: entry.label, key: keyOf(index) }));
    const leftChoice: Segments = segments("Left", choices, String(left), (value) => choose("left", Number(value)));
    const rightChoice: Segments = segments("Right", choices, String(right), (value) => choose("right", Number(value)));
    const leftError = toggle("error", "E", "Error of the left image", (on) => setErrors({ ...errors, left: on }));
    const rightError = toggle("error", "⇧E", "Error of the right image", (on) => setErrors({ ...errors, right: on }));
    const leftGroup = h("span", { class: "side" }, leftChoice.element, truth ? leftError.element : null);
    const rightGroup = h("span", { class: "side" }, rightChoice.element, truth ? rightError.element : null);
    const layerChoice: Segments = segments(
        "Layer",
        layers.map((one) => ({ value: one.key, label: one.label })),
        layer.key,
        (value) => setLayer(value),
    );
    const modeChoice: Segments = segments(
        "View",
        [
            { value: "divider", label: "divider" },
            { value: "all", label: "all" },
        ],
        "divider",
        (value) => setAll(value === "all"),
    );
    const exposure = h("input", {
        type: "range",
        min: -kStops,
        max: kStops,
        step: 0.25,
        value: 0,
        "aria-label": "Exposure, stops",
        input: () => setExposure(Number(exposure.value)),
    });
    const exposureText = h("output", { class: "exposure" });
    const zoomText = h("output", { class: "zoom" });
    const button = (text: string, title: string, press: () => void): HTMLElement =>
        h("button", { type: "button", title, "aria-label": title, click: press }, text);
    const handle = h("div", {
        class: "handle",
        role: "slider",
        tabindex: 0,
        "aria-label": "Divider between left and right image",
        "aria-valuemin": 0,
        "aria-valuemax": 100,
    });
    const leftName = h("span", { class: "badge left" });
    const rightName = h("span", { class: "badge right" });
    const problem = h("p", { class: "problem", role: "status" });
    const captions = entries.map(() => h("span", {}));
    const stage = h("div", { class: "stage" });
    const values = h("dl", { class: "values", "aria-live": "polite" });
    const legend = h("div", { class: "colours" });
    const viewer = h(
        "div",
        { class: "viewer" },
        h("div", { class: "controls" }, leftGroup, rightGroup, layerChoice.element, modeChoice.element),
        h(
            "div",
            { class: "controls" },
            h(
                "div",
                { class: "field" },
                h("span", {}, "Exposure"),
                exposure,
                exposureText,
                button("auto", "auto exposure", () => setExposure(0)),
            ),
            h(
                "div",
                { class: "field" },
                h("span", {}, "Zoom"),
                button("−", "Zoom out", () => zoomBy(1 / 1.5)),
                zoomText,
                button("+", "Zoom in", () => zoomBy(1.5)),
                button("whole", "Whole image", () => whole()),
            ),
        ),
        h("div", { class: "viewer-body" }, stage, h("div", { class: "beside" }, values, legend, problem, keysHelp())),
    );

    // What each control does.
    function choose(side: "left" | "right", index: number): void {
        if (!entries[index]) return;
        if (side === "left") left = index;
        else right = index;
        leftChoice.set(String(left));
        rightChoice.set(String(right));
        void reload();
    }
    function setErrors(next: typeof errors): void {
        errors = next;
        leftError.set(errors.left);
        rightError.set(errors.right);
        void reload();
    }
    function setLayer(key: string): void {
        layer = layers.find((one) => one.key === key) ?? layer;
        layerChoice.set(layer.key);
        void reload();
    }
    function setAll(value: boolean): void {
        all = value;
        modeChoice.set(all ? "all" : "divider");
        leftChoice.element.hidden = rightGroup.hidden = all;
        layOut();
        void reload();
    }
    function setExposure(value: number): void {
        stops = Math.min(kStops, Math.max(-kStops, value));
        exposure.value = String(stops);
        repaint();
    }
    function whole(): void {
        view = { zoom: 0, x: width / 2, y: height / 2 };
        redraw();
    }
    /** Zooms so that the image's pixel at the place stays where it is. */
    function zoomBy(factor: number, clientX?: number, clientY?: number, pane = panes[0]): void {
        if (!pane) return;
        const before = pane.zoomOf(view);
        const least = pane.zoomOf({ ...view, zoom: 0 });
        const zoom = Math.min(kZoomMost, Math.max(least, before * factor));
        const area = pane.canvas.getBoundingClientRect();
        const [dx, dy] = [
            (clientX ?? area.left + area.width / 2) - area.left - area.width / 2,
            (clientY ?? area.top + area.height / 2) - area.top - area.height / 2,
        ];
        if (zoom <= least * 1.001) return whole();
        move(view.x + dx / before - dx / zoom, view.y + dy / before - dy / zoom, zoom);
    }
    /** Keeps the middle of the view on the image. */
    function move(x: number, y: number, zoom = view.zoom): void {
        view = { zoom, x: Math.min(width, Math.max(0, x)), y: Math.min(height, Math.max(0, y)) };
        redraw();
    }
    function setSplit(share: number): void {
        split = Math.min(1, Math.max(0, share));
        redraw();
    }
    function point(x: number, y: number): void {
        cursor = x >= 0 && y >= 0 && x < width && y < height ? [x, y] : null;
        redraw();
    }

    // Loading, painting, drawing: each does what the ones after it need.
    let turn = 0;
    async function reload(): Promise<void> {
        const mine = ++turn;
        const one = (index: number, error: boolean): Promise<Loaded> => load(entries[index] as Entry, layer, error ? truth : undefined);
        const wanted = all ? entries.map((_, index) => one(index, errors.left)) : [one(left, errors.left), one(right, errors.right)];
        const truthLoaded = truth && layer.colours ? await load(truth, layer, undefined) : null;
        const loaded = await Promise.all(wanted);
        if (mine !== turn) return; // something else was chosen meanwhile
        auto = layer.colours ? sharedExposure(truthLoaded, loaded) : 1;
        shown = loaded.map((one) => ({ loaded: one, canvas: null }));
        repaint();
    }
    function repaint(): void {
        const images = shown.map((one) => one.loaded.image).filter((image): image is ReportImage => image !== null);
        const how = { tones: toneTable(auto * 2 ** stops), top: layer.colours ? 1 : topOf(images) };
        for (const one of shown) one.canvas = paint(one.loaded, layer, how);
        exposureText.textContent = `${stops >= 0 ? "+" : "−"}${Math.abs(stops).toFixed(2)} EV`;
        exposureText.title = `radiance × ${number(auto * 2 ** stops)}`;
        problem.textContent = [...new Set(shown.map((one) => one.loaded.problem).filter(Boolean))].join(" ");
        const anyError = shown.some((one) => one.loaded.reference);
        legend.replaceChildren(...legendOf(layer, images, how.top, anyError));
        redraw();
    }
    const drawPanes = perFrame(() => {
        if (all) panes.forEach((pane, index) => pane.draw(shown[index]?.canvas ?? null, null, 1, view, cursor));
        else panes[0]?.draw(shown[0]?.canvas ?? null, shown[1]?.canvas ?? null, split, view, cursor);
    });
    function redraw(): void {
        drawPanes();
        handle.style.left = `${100 * split}%`;
        handle.setAttribute("aria-valuenow", String(Math.round(100 * split)));
        handle.setAttribute("aria-valuetext", `${Math.round(100 * split)} % ${shown[0]?.loaded.label ?? ""}`);
        leftName.textContent = shown[0]?.loaded.label ?? "";
        captions.forEach((caption, index) => (caption.textContent = shown[index]?.loaded.label ?? ""));
        rightName.textContent = shown[1]?.loaded.label ?? "";
        zoomText.textContent = panes[0] ? `${Math.round(100 * panes[0].zoomOf(view))} %` : "";
        drawValues();
    }
    function drawValues(): void {
        const rows: Node[] = [
            h("dt", {}, "pixel"),
            h("dd", {}, cursor ? `${cursor[0]}, ${cursor[1]}` : "point at the image, or use the arrows"),
        ];
        for (const one of cursor ? shown : [])
            rows.push(
                h("dt", { title: one.loaded.label }, one.loaded.label),
                h("dd", {}, cursor ? pixelText(one.loaded, layer, cursor[0], cursor[1], probeText) : ""),
            );
        values.replaceChildren(...rows);
    }
    function probeText(entry: Entry, probe: number): string {
        const found = scene.probe_sets?.[entry.point?.probe_set ?? ""]?.probes?.[probe];
        return found ? `probe ${probe} at ${found.position.map((part) => number(part)).join(", ")}: ${found.why ?? ""}` : `probe ${probe}`;
    }
    function layOut(): void {
        const label = (text: string): string => `${text}. Arrow keys move from pixel to pixel.`;
        panes = all
            ? entries.map((entry) => imagePane(width, height, label(entry.label)))
            : [imagePane(width, height, label("Left and right image"))];
        stage.className = all ? "stage all" : "stage";
        stage.style.setProperty("--aspect", String(width / height));
        if (all)
            stage.replaceChildren(
                ...panes.map((pane, index) =>
                    h(
                        "figure",
                        {},
                        pane.canvas,
                        h("figcaption", { class: "clip" }, h("kbd", {}, keyOf(index) ?? ""), " ", captions[index] as HTMLElement),
                    ),
                ),
            );
        else stage.replaceChildren((panes[0] as Pane).canvas, leftName, rightName, handle);
        for (const pane of panes) listen(pane);
        new ResizeObserver(redraw).observe((panes[0] as Pane).canvas);
    }

    function listen(pane: Pane): void {
        const { canvas } = pane;
        canvas.tabIndex = 0;
        canvas.setAttribute("role", "application");
        canvas.addEventListener("pointermove", (event) => point(...pane.pixelAt(event.clientX, event.clientY, view)));
        canvas.addEventListener("pointerleave", () => {
            if (document.activeElement !== canvas) point(-1, -1);
        });
        onDrag(canvas, (_, dx, dy) => {
            if (view.zoom) move(view.x - dx / view.zoom, view.y - dy / view.zoom);
        });
        canvas.addEventListener("dblclick", () => whole());
        canvas.addEventListener(
            "wheel",
            (event) => {
                if (!event.ctrlKey && !viewer.contains(document.activeElement)) return; // then it scrolls the page
                event.preventDefault();
                zoomBy(Math.exp(-event.deltaY / 300), event.clientX, event.clientY, pane);
            },
            { passive: false },
        );
        canvas.addEventListener("keydown", (event) => {
            const steps: Record<string, [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
            const step = steps[event.key];
            if (!step) return;
            event.preventDefault();
            if (event.shiftKey) {
                const by = 0.1 * (canvas.clientWidth / pane.zoomOf(view));
                if (view.zoom) move(view.x + by * step[0], view.y + by * step[1]);
                return;
            }
            const [x, y] = cursor ?? [Math.floor(view.x) - step[0], Math.floor(view.y) - step[1]];
            point(Math.min(width - 1, Math.max(0, x + step[0])), Math.min(height - 1, Math.max(0, y + step[1])));
        });
    }
    onDrag(handle, (event) => {
        const area = stage.getBoundingClientRect();
        setSplit((event.clientX - area.left) / area.width);
    });
    handle.addEventListener("keydown", (event) => {
        const step = event.shiftKey ? 0.1 : 0.02;
        const to: Record<string, number> = {
            ArrowLeft: split - step,
            ArrowDown: split - step,
            ArrowRight: split + step,
            ArrowUp: split + step,
            Home: 0,
            End: 1,
        };
        const share = to[event.key];
        if (share === undefined) return;
        event.preventDefault();
        setSplit(share);
    });
    viewer.addEventListener("keydown", (event) => {
        if (event.ctrlKey || event.altKey || event.metaKey || event.defaultPrevented) return;
        const shift = event.shiftKey;
        const digit = /^Digit([1-9])$/.exec(event.code)?.[1];
        const actions: Record<string, () => void> = {
            x: () => {
                const before = left;
                choose("left", right);
                choose("right", before);
                setErrors({ left: errors.right, right: errors.left });
            },
            e: () => {
                if (truth) setErrors(shift ? { ...errors, right: !errors.right } : { ...errors, left: !errors.left });
            },
            l: () => setLayer(layers[(layers.indexOf(layer) + 1) % layers.length]?.key ?? layer.key),
            v: () => setAll(!all),
            "[": () => setExposure(stops - 0.25),
            "]": () => setExposure(stops + 0.25),
            "+": () => zoomBy(1.5),
            "=": () => zoomBy(1.5),
            "-": () => zoomBy(1 / 1.5),
            "0": () => whole(),
        };
        const action = digit ? () => choose(shift ? "right" : "left", Number(digit) - 1) : actions[event.key.toLowerCase()];
        if (!action) return;
        event.preventDefault();
        action();
    });
    store.on(["show"], () => {
        const index = entries.findIndex((entry) => entry.point === store.shown);
        if (index >= 0) choose("left", index);
        viewer.scrollIntoView({ block: "start" });
    });

    layOut();
    // Unpacked when it comes near the window: a page of many scenes opens at once.
    new IntersectionObserver(
        (seen, observer) => {
            if (!seen.some((one) => one.isIntersecting)) return;
            observer.disconnect();
            void reload();
        },
        { rootMargin: "400px" },
    ).observe(viewer);
    return section(
        "images",
        "Images",
        truth ? null : h("p", { class: "note" }, "There is no reference image, so no error can be shown."),
        viewer,
    );
}
