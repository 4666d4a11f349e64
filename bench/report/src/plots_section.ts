// Error against time, reads and memory.
import { details } from "./details";
import { h, section, select } from "./dom";
import { errorFigures, figure, measured, type Figure } from "./figures";
import { glyph, methodName, type MethodStyle } from "./methods";
import { isNumber, methodsOf, points, type Scene } from "./results";
import { scatter } from "./scatter";
import type { Store } from "./store";

const kCosts = ["frame_ms", "rays.reads_mean", "bytes.total"];

export function plotsSection(scene: Scene, styles: Map<string, MethodStyle>, store: Store): HTMLElement {
    const found = measured(points(scene), errorFigures);
    const offered = found.length > 0 ? found : errorFigures;
    const first = offered[0] as Figure;
    const timed = measured(points(scene), [figure("frame_ms")]).length > 0;
    const costs = kCosts.map((key) => (key === "frame_ms" && !timed ? figure("trace_ms") : figure(key)));
    /** What can't be told from the truth: the errors' standard error by the reference's noise, or its own relMSE where there are none. */
    const noiseOf = (error: Figure): number | null => {
        const layer = /^error\.(.*)\.relmse$/.exec(error.key)?.[1];
        const unsure = points(scene)
            .map((point) => point.error?.[layer ?? ""]?.relmse_unsure)
            .filter(isNumber);
        const noise = unsure.length > 0 ? Math.max(...unsure) : scene.reference?.estimated_relmse?.[layer ?? ""];
        return isNumber(noise) && noise > 0 ? noise : null;
    };
    const plots = costs.map((cost) => scatter(points(scene), cost, first, noiseOf, styles, store));

    const legend = h("div", { class: "legend", role: "group", "aria-label": "Methods shown" });
    for (const method of methodsOf(scene)) {
        const button = h(
            "button",
            { type: "button", "aria-pressed": "true", title: `Show or hide ${methodName(method)}`, click: () => store.toggle(method) },
            glyph(styles.get(method)),
            h("span", { class: "clip" }, methodName(method)),
        );
        store.on(["methods"], () => button.setAttribute("aria-pressed", String(!store.hidden.has(method))));
        legend.append(button);
    }
    const knobs = [...new Set(points(scene).map((point) => point.knob))].filter((knob) => knob && knob !== "default");
    const errors = select(
        "Error",
        offered.map((of) => ({ value: of.key, label: of.label })),
        first.key,
        (key) => {
            for (const plot of plots) plot.setError(figure(key));
        },
    );
    const knob = select("Knob", [{ value: "", label: "all" }, ...knobs.map((name) => ({ value: name, label: name }))], "", (name) =>
        store.highlight(name),
    );
    return section(
        "plots",
        "What accuracy costs",
        h(
            "p",
            { class: "lead" },
            "Low and left is better. Thick grey: the Pareto front of all that is shown. Thin lines: each method's own front. Large marks: default settings. Hollow marks: a wrong image. Dashed: the noise of the reference itself. Drag to zoom, double-click for the whole; the wheel zooms with Ctrl or after a click.",
        ),
        h("div", { class: "controls" }, errors, knob, legend),
        h("div", { class: "plots" }, ...plots.map((plot) => plot.element)),
        details(scene, styles, store),
    );
}
