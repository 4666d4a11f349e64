// Where the probes are and why each is there: seen from above, from the front or from the side.
import { categorical, css } from "./colour_maps";
import { h, section, segments, select, svg } from "./dom";
import { counted, number, percent, seconds } from "./format";
import { swatch } from "./image_legend";
import { gridShape, points, type ProbeSet, type Scene } from "./results";
import { table, type Column } from "./table";
import { hideTooltip, showTooltip } from "./tooltip";

type Probe = NonNullable<ProbeSet["probes"]>[number];
type Side = "above" | "front" | "side";
/** Axes to the right, down the page and towards the eye, and which way the last runs: with z to the right and y up, x runs away. */
const kAxes: Record<Side, [0 | 1 | 2, 0 | 1 | 2, 0 | 1 | 2, 1 | -1]> = { above: [0, 2, 1, 1], front: [0, 1, 2, 1], side: [2, 1, 0, -1] };
const kNames = ["x", "y", "z"];
const kReach = 14; // CSS pixels

/** What stands before the first comma or number of `why`: the reasons fall into few kinds. */
function reasonOf(probe: Probe): string {
    return (
        (probe.why ?? "")
            .split(",")[0]
            ?.replace(/[\s\d.:;-]+$/, "")
            .trim() || "no reason given"
    );
}

function plan(
    scene: Scene,
    set: ProbeSet,
    side: Side,
    reasons: string[],
    chosen: (probe: number) => void,
): { element: HTMLElement; mark(probe: number): void } {
    const [right, down, toward, sense] = kAxes[side];
    const probes = set.probes ?? [];
    const low = [...(scene.bounds?.min ?? [Infinity, Infinity, Infinity])];
    const high = [...(scene.bounds?.max ?? [-Infinity, -Infinity, -Infinity])];
    for (const probe of probes)
        probe.position.forEach((value, axis) => {
            low[axis] = Math.min(low[axis] as number, value);
            high[axis] = Math.max(high[axis] as number, value);
        });
    const span = (axis: number): number => Math.max((high[axis] as number) - (low[axis] as number), 1e-6);
    const size = Math.max(span(right), span(down));
    const margin = 0.03 * size;
    const upright = down === 1; // y grows upwards
    const place = (p: number[]): [number, number] => [p[right] as number, upright ? -(p[down] as number) : (p[down] as number)];
    const top = upright ? -(high[down] as number) : (low[down] as number);
    const box = [(low[right] as number) - margin, top - margin, span(right) + 2 * margin, span(down) + 2 * margin];
    const radius = 0.011 * size;

    const walls = side === "above" ? (scene.plan?.segments ?? []).map(([x0, z0, x1, z1]) => `M${x0} ${z0}L${x1} ${z1}`).join("") : "";
    const drawing = svg("svg", {
        class: "plan",
        viewBox: box.join(" "),
        tabindex: 0,
        role: "application",
        "aria-label": `${counted(probes.length, "probe")} seen from ${side === "above" ? "above" : `the ${side}`}. Arrow keys go from probe to probe.`,
    });
    // Under the probes in a drawing of its own: thousands of lines are not drawn again for every probe that lights up.
    const ground = svg(
        "svg",
        { class: "plan ground", viewBox: box.join(" "), "aria-hidden": "true" },
        svg("rect", { class: "bounds", x: low[right], y: top, width: span(right), height: span(down) }),
        svg("path", { class: "walls", d: walls || "M0 0" }),
    );
    const dots = probes.map((probe, index) => {
        const [x, y] = place(probe.position);
        const farthest = (sense > 0 ? low[toward] : high[toward]) as number;
        const near = ((sense * ((probe.position[toward] as number) - farthest)) / span(toward)) * 1.05 + 0.55; // nearer to the eye is larger
        return svg("circle", {
            cx: x,
            cy: y,
            r: radius * near,
            fill: css(categorical(reasons.indexOf(reasonOf(probe)))),
            "data-probe": index,
        });
    });
    // The nearest first: of probes over each other, the smaller ones show as rings within the larger.
    const order = dots.map((_, index) => index).sort((a, b) => sense * ((probes[b]?.position[toward] ?? 0) - (probes[a]?.position[toward] ?? 0)));
    drawing.append(...order.map((index) => dots[index] as SVGCircleElement));

    let current = -1;
    const mark = (probe: number): void => {
        dots[current]?.classList.remove("lit");
        current = probe;
        dots[current]?.classList.add("lit");
    };
    const explain = (found: number[]): void => {
        const first = found[0] as number;
        mark(first);
        const area = (dots[first] as SVGCircleElement).getBoundingClientRect();
        const lines = found.slice(0, 6).map((index) => {
            const probe = probes[index] as Probe;
            return h(
                "p",
                {},
                h("strong", {}, `probe ${index}`),
                ` at ${probe.position.map((value) => number(value)).join(", ")}`,
                h("br"),
                probe.why ?? "no reason given",
            );
        });
        showTooltip(area.right, area.top, ...lines, ...(found.length > 6 ? [`and ${found.length - 6} more here`] : []));
    };
    const near = (event: MouseEvent): number[] => {
        const matrix = drawing.getScreenCTM();
        if (!matrix) return [];
        const distances = probes.map((probe, index): [number, number] => {
            const [x, y] = place(probe.position);
            return [Math.hypot(matrix.a * x + matrix.e - event.clientX, matrix.d * y + matrix.f - event.clientY), index];
        });
        distances.sort((a, b) => a[0] - b[0]);
        const nearest = distances[0]?.[0] ?? Infinity;
        return distances.filter(([distance]) => distance < kReach && distance < nearest + 2).map(([, index]) => index);
    };
    drawing.addEventListener("mousemove", (event) => {
        const found = near(event);
        if (found.length > 0) explain(found);
        else {
            mark(-1);
            hideTooltip();
        }
    });
    drawing.addEventListener("click", (event) => {
        const found = near(event)[0];
        if (found !== undefined) chosen(found);
    });
    for (const leave of ["mouseleave", "blur"]) drawing.addEventListener(leave, () => hideTooltip());
    drawing.addEventListener("keydown", (event) => {
        const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
        if (step === undefined || probes.length === 0) return;
        event.preventDefault();
        explain([(current + step + probes.length) % probes.length]);
    });
    return { element: h("div", { class: "plan-stack" }, ground, drawing), mark };
}

export function planSection(scene: Scene): HTMLElement {
    const sets = Object.entries(scene.probe_sets ?? {}).filter(([, set]) => (set.probes ?? []).length > 0);
    if (sets.length === 0) return section("probes", "Probes", h("p", { class: "note" }, "This scene has no probe sets."));
    const setOf = (name: string): ProbeSet => scene.probe_sets?.[name] as ProbeSet;
    const defaults = points(scene).filter((point) => point.knob === "default" && point.probe_set);
    const firstName =
        defaults.find((point) => point.method === "ours" && sets.some(([name]) => name === point.probe_set))?.probe_set ??
        (sets[0] as [string, ProbeSet])[0];
    const count = setOf(firstName).probes?.length ?? 0;
    const others = sets.filter(([name]) => name !== firstName);
    // beside it: a grid with about as many probes, where there is one
    others.sort(
        ([, a], [, b]) =>
            Number(b.method === "grid") - Number(a.method === "grid") ||
            Math.abs((a.probes?.length ?? 0) - count) - Math.abs((b.probes?.length ?? 0) - count),
    );
    const names = [firstName, ...(others[0] ? [others[0][0]] : [])];
    const reasons = [...new Set(sets.flatMap(([, set]) => (set.probes ?? []).map(reasonOf)))].sort();
    let side: Side = "above";

    const body = h("div", { class: "plans" });
    const legend = h(
        "div",
        { class: "swatches" },
        ...reasons.slice(0, 24).map((reason, index) => swatch(categorical(index), reason)),
        reasons.length > 24 ? "…" : "",
    );
    const axes = h("p", { class: "note" });

    const probeColumns = (of: ProbeSet): Column<Probe>[] => [
        {
            head: "probe",
            numeric: true,
            sortBy: (probe) => of.probes?.indexOf(probe) ?? 0,
            show: (probe) => String(of.probes?.indexOf(probe) ?? 0),
        },
        ...kNames.map((name, axis): Column<Probe> => ({
            head: `${name}, m`,
            numeric: true,
            sortBy: (probe) => probe.position[axis] ?? null,
            show: (probe) => number(probe.position[axis]),
        })),
        { head: "why it is there", sortBy: (probe) => probe.why ?? null, show: (probe) => probe.why ?? "" },
    ];
    const update = (): void => {
        const [right, down] = kAxes[side];
        axes.textContent = `${kNames[right]} to the right, ${kNames[down]} ${down === 1 ? "up" : "down"}; larger is nearer to the eye.${side === "above" && (scene.plan?.segments ?? []).length > 0 ? " Lines: the scene cut at the probes' median height." : ""}`;
        body.replaceChildren(
            ...names.map((name, index) => {
                const set = setOf(name);
                const of = set.probes ?? [];
                const drawn = plan(scene, set, side, reasons, (probe) => {
                    list.open = true;
                    rows.rowOf(of[probe] as Probe)?.scrollIntoView({ block: "nearest" });
                });
                const rows = table(`Probes of ${name}`, probeColumns(set), of, { picked: (probe) => drawn.mark(of.indexOf(probe)) });
                rows.element.classList.add("short");
                const list = h("details", {}, h("summary", {}, `List of ${counted(of.length, "probe")}`), rows.element);
                const facts = [
                    counted(of.length, "probe"),
                    set.method,
                    gridShape(set),
                    set.coverage?.rays !== undefined ? `${percent(set.coverage?.rays)} % of surface rays seen` : "",
                    set.seconds !== undefined ? `placed in ${seconds(set.seconds)}` : "",
                ];
                const choice = select(
                    `Set ${index + 1}`,
                    sets.map(([value]) => ({ value, label: value })),
                    name,
                    (value) => {
                        names[index] = value;
                        update();
                    },
                );
                return h(
                    "div",
                    { class: "plan-cell" },
                    choice,
                    h("p", { class: "note" }, facts.filter(Boolean).join(" · ")),
                    drawn.element,
                    list,
                );
            }),
        );
    };
    const sides = segments(
        "Seen from",
        [
            { value: "above", label: "above" },
            { value: "front", label: "the front" },
            { value: "side", label: "the side" },
        ],
        side,
        (value) => {
            side = value as Side;
            update();
        },
    );
    update();
    return section("probes", "Probes", h("div", { class: "controls" }, sides.element, legend), axes, body);
}
