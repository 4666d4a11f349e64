// A plot of points, error against a cost, both logarithmic. uPlot does axes and zoom; points, fronts and hovering are drawn here.
import uPlot from "uplot";
import { h, perFrame } from "./dom";
import { counted, number } from "./format";
import { withUnit, type Figure } from "./figures";
import { titleOf, type MethodStyle } from "./methods";
import { paretoFront, type Placed } from "./pareto";
import { isNumber, type Point } from "./results";
import type { Store } from "./store";
import { colourOf } from "./theme";
import { logTicks, paddedRange } from "./ticks";
import { hideTooltip, showTooltip } from "./tooltip";

const kHeight = 300; // CSS pixels
const kNear = 4; // times the noise of the reference: errors below it make its line worth showing
const kReach = 18; // CSS pixels from the pointer to a point it means

export interface Scatter {
    element: HTMLElement;
    setError(error: Figure): void;
}

/** @param noiseOf  the error that the reference itself has; null where it isn't known */
export function scatter(
    all: Point[],
    cost: Figure,
    firstError: Figure,
    noiseOf: (error: Figure) => number | null,
    styles: Map<string, MethodStyle>,
    store: Store,
): Scatter {
    let error = firstError;
    let placed: Placed<Point>[] = [];
    let view = { x: [0.1, 10] as [number, number], y: [0.1, 10] as [number, number] };

    const note = h("p", { class: "note" });
    const frame = h("div", { class: "plot", tabindex: 0, role: "application" });
    const title = h("h3", {});
    const reset = h("button", { type: "button", class: "quiet", click: () => fit() }, "whole");
    const element = h("div", { class: "plot-cell" }, h("div", { class: "plot-head" }, title, reset), frame, note);

    const shapes = new Map<string, Path2D>();
    for (const [method, style] of styles) shapes.set(method, new Path2D(style.outline));

    function place(): void {
        const shown = all.filter((point) => store.visible(point));
        placed = [];
        for (const point of shown) {
            const x = cost.of(point);
            const y = error.of(point);
            if (x !== null && y !== null && x > 0 && y > 0) placed.push({ x: x * cost.axis, y: y * error.axis, item: point });
        }
        const unit = (of: Figure): string => (of.unit ? `, ${of.unit}` : "");
        title.textContent = `${error.label}${unit(error)} against ${cost.label}${unit(cost)}`;
        frame.setAttribute(
            "aria-label",
            `Plot of ${title.textContent}: ${counted(placed.length, "point")}. Arrow keys go from point to point, Enter picks one, plus and minus zoom, 0 shows all.`,
        );
        const left = shown.length - placed.length;
        note.textContent = left > 0 ? `${left} of ${counted(shown.length, "point")} without a figure here` : "";
    }

    function fit(): void {
        zoom(range());
    }
    function zoom(next: typeof view): void {
        view = next;
        plot?.batch((u: uPlot) => {
            u.setScale("x", { min: next.x[0], max: next.x[1] });
            u.setScale("y", { min: next.y[0], max: next.y[1] });
        });
    }
    /** Zooms about a place; factor below 1 goes in. */
    function zoomAbout(x: number, y: number, factor: number): void {
        const about = (range: [number, number], at: number): [number, number] => [
            at * (range[0] / at) ** factor,
            at * (range[1] / at) ** factor,
        ];
        zoom({ x: about(view.x, x), y: about(view.y, y) });
    }

    place();
    view = range();

    const axis = (rotated: boolean): uPlot.Axis => ({
        stroke: () => colourOf("--ink-2"),
        font: "12px system-ui, sans-serif",
        size: rotated ? 56 : 34,
        grid: { stroke: () => colourOf("--line"), width: 1 },
        ticks: { stroke: () => colourOf("--line"), width: 1, size: 4 },
        splits: (_: uPlot, __: number, low: number, high: number) => logTicks(low, high, 8),
        filter: (_: uPlot, splits: number[]) => splits,
        values: (_: uPlot, splits: number[]) => splits.map((value) => trimmed(value)),
    });
    let plot: uPlot | null = null;
    plot = new uPlot(
        {
            width: 360,
            height: kHeight,
            padding: [8, 10, 0, 0],
            legend: { show: false },
            cursor: {
                x: false,
                y: false,
                points: { show: false },
                drag: { x: true, y: true, uni: 8, setScale: true },
                bind: { dblclick: () => () => (fit(), null) },
            },
            scales: { x: { time: false, distr: 3, range: () => view.x }, y: { distr: 3, range: () => view.y } },
            axes: [axis(false), axis(true)],
            series: [{}, { paths: () => null, points: { show: false } }],
            hooks: {
                setScale: [
                    (u) => {
                        const { x, y } = u.scales;
                        if (x && y && isNumber(x.min) && isNumber(x.max) && isNumber(y.min) && isNumber(y.max))
                            view = { x: [x.min, x.max], y: [y.min, y.max] };
                    },
                ],
                draw: [draw],
            },
        },
        [
            [view.x[0], view.x[1]],
            [view.y[0], view.y[1]],
        ],
        frame,
    );
    const over = plot.over;

    /** The whole range of what is placed, and of the noise where it is near. */
    function range(): typeof view {
        const errors = placed.map((p) => p.y);
        const noise = noiseOf(error);
        if (noise !== null && errors.some((y) => y < kNear * noise * error.axis)) errors.push(noise * error.axis);
        return { x: paddedRange(placed.map((p) => p.x)), y: paddedRange(errors) };
    }

    function draw(u: uPlot): void {
        const { ctx, bbox } = u;
        ctx.save();
        ctx.beginPath();
        ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
        ctx.clip();
        ctx.lineJoin = "round";
        const colours = new Map([...styles].map(([method, style]) => [method, colourOf(style.colour)]));
        const usable = placed.filter((p) => !p.item.wrong && store.stands(p.item));
        drawFront(u, paretoFront(usable));
        drawNoise(u);
        for (const [method, colour] of colours) {
            ctx.strokeStyle = colour; // each method's own front
            ctx.lineWidth = 1.25 * devicePixelRatio;
            ctx.beginPath();
            paretoFront(usable.filter((p) => p.item.method === method)).forEach((p) => ctx.lineTo(...canvasPosition(u, p)));
            ctx.stroke();
        }
        drawMarks(u, colours);
        ctx.restore();
    }
    function canvasPosition(u: uPlot, p: Placed<Point>): [number, number] {
        return [u.valToPos(p.x, "x", true), u.valToPos(p.y, "y", true)];
    }
    /** Steps: what lies above and right of them is beaten. */
    function drawFront(u: uPlot, front: Placed<Point>[]): void {
        const { ctx, bbox } = u;
        ctx.strokeStyle = colourOf("--front");
        ctx.lineWidth = 5 * devicePixelRatio;
        ctx.beginPath();
        let height = bbox.top;
        for (const p of front) {
            const [x, y] = canvasPosition(u, p);
            ctx.lineTo(x, height);
            ctx.lineTo(x, y);
            height = y;
        }
        if (front.length > 0) ctx.lineTo(bbox.left + bbox.width, height);
        ctx.stroke();
    }
    function drawNoise(u: uPlot): void {
        const noise = noiseOf(error);
        if (noise === null) return;
        const { ctx, bbox } = u;
        const y = u.valToPos(noise * error.axis, "y", true);
        ctx.save();
        ctx.strokeStyle = colourOf("--ink-2");
        ctx.lineWidth = devicePixelRatio;
        ctx.setLineDash([5 * devicePixelRatio, 4 * devicePixelRatio]);
        ctx.beginPath();
        ctx.moveTo(bbox.left, y);
        ctx.lineTo(bbox.left + bbox.width, y);
        ctx.stroke();
        ctx.restore();
    }
    function drawMarks(u: uPlot, colours: Map<string, string>): void {
        const { ctx } = u;
        const paper = colourOf("--paper");
        const ink = colourOf("--ink");
        const lit = (p: Placed<Point>): boolean => p.item === store.hovered || p.item === store.picked;
        const rank = (p: Placed<Point>): number => (lit(p) ? 2 : store.stands(p.item) ? 1 : 0);
        for (const p of [...placed].sort((a, b) => rank(a) - rank(b))) {
            const shape = shapes.get(p.item.method);
            if (!shape) continue;
            const colour = colours.get(p.item.method) ?? ink;
            const size = (lit(p) ? 7 : p.item.knob === "default" ? 6 : 4.5) * devicePixelRatio;
            ctx.save();
            ctx.translate(...canvasPosition(u, p));
            ctx.scale(size, size);
            ctx.lineWidth = ((lit(p) ? 2 : 1) * devicePixelRatio) / size;
            ctx.globalAlpha = rank(p) > 0 ? 1 : 0.2;
            ctx.fillStyle = p.item.wrong ? paper : colour;
            ctx.strokeStyle = lit(p) ? ink : p.item.wrong ? colour : paper;
            ctx.fill(shape);
            ctx.stroke(shape);
            ctx.restore();
        }
    }

    /** Where a point stands on the page, CSS pixels in the plot's area. */
    function positionOf(p: Placed<Point>): [number, number] {
        return [plot?.valToPos(p.x, "x") ?? 0, plot?.valToPos(p.y, "y") ?? 0];
    }
    function nearest(x: number, y: number): Placed<Point> | null {
        let best: Placed<Point> | null = null;
        let bestDistance = kReach;
        for (const p of placed) {
            const [px, py] = positionOf(p);
            const distance = Math.hypot(px - x, py - y) + (store.stands(p.item) ? 0 : 4);
            if (distance < bestDistance) [best, bestDistance] = [p, distance];
        }
        return best;
    }
    function explain(p: Placed<Point>): void {
        store.hover(p.item);
        const area = over.getBoundingClientRect();
        const [x, y] = positionOf(p);
        showTooltip(area.left + x, area.top + y, ...tooltipOf(p.item, cost, error));
    }

    over.addEventListener("mousemove", (event) => {
        const area = over.getBoundingClientRect();
        const p = nearest(event.clientX - area.left, event.clientY - area.top);
        over.style.cursor = p ? "pointer" : "crosshair";
        if (p) explain(p);
        else {
            store.hover(null);
            hideTooltip();
        }
    });
    over.addEventListener("mouseleave", () => {
        store.hover(null);
        hideTooltip();
    });
    let pressed: [number, number] = [0, 0];
    over.addEventListener("mousedown", (event) => (pressed = [event.clientX, event.clientY]));
    over.addEventListener("click", (event) => {
        if (Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) > 3) return; // it was a drag
        const area = over.getBoundingClientRect();
        const p = nearest(event.clientX - area.left, event.clientY - area.top);
        if (p) store.pick(p.item);
    });
    frame.addEventListener(
        "wheel",
        (event) => {
            if (!event.ctrlKey && document.activeElement !== frame) return; // then it scrolls the page
            event.preventDefault();
            const area = over.getBoundingClientRect();
            if (plot)
                zoomAbout(
                    plot.posToVal(event.clientX - area.left, "x"),
                    plot.posToVal(event.clientY - area.top, "y"),
                    Math.exp(event.deltaY / 500),
                );
        },
        { passive: false },
    );
    over.addEventListener("mouseup", () => frame.focus({ preventScroll: true }));
    frame.addEventListener("keydown", (event) => {
        const middle = (range: [number, number]): number => Math.sqrt(range[0] * range[1]);
        const current = placed.findIndex((p) => p.item === store.hovered);
        const go = (step: number): void => {
            const order = [...placed].sort((a, b) => a.x - b.x || a.y - b.y);
            const from = order.findIndex((p) => p.item === store.hovered);
            const p = order[from < 0 ? 0 : Math.min(order.length - 1, Math.max(0, from + step))];
            if (p) explain(p);
        };
        const pick = placed[current];
        if (event.key === "ArrowRight" || event.key === "ArrowDown") go(1);
        else if (event.key === "ArrowLeft" || event.key === "ArrowUp") go(-1);
        else if (event.key === "+" || event.key === "=") zoomAbout(middle(view.x), middle(view.y), 0.7);
        else if (event.key === "-") zoomAbout(middle(view.x), middle(view.y), 1 / 0.7);
        else if (event.key === "0") fit();
        else if (event.key === "Enter" && pick) store.pick(pick.item);
        else if (event.key === "Escape") hideTooltip();
        else return;
        event.preventDefault();
    });
    frame.addEventListener("blur", () => {
        store.hover(null);
        hideTooltip();
    });

    store.on(
        ["hover", "pick", "knob", "theme"],
        perFrame(() => plot?.redraw(false, true)),
    );
    store.on(["methods"], () => {
        place();
        fit();
    });
    new ResizeObserver(([entry]) => {
        const width = Math.floor(entry?.contentRect.width ?? 0);
        if (width > 0 && plot && width !== plot.width) plot.setSize({ width, height: kHeight });
    }).observe(frame);

    return {
        element,
        setError(next) {
            error = next;
            place();
            fit();
        },
    };
}

function trimmed(value: number): string {
    if (value !== 0 && (value < 1e-3 || value >= 1e5))
        return value
            .toExponential(value.toExponential().startsWith("1e") ? 0 : 1)
            .replace("e+", "e")
            .replace(".0e", "e");
    return String(Number(value.toPrecision(3)));
}

function spreadOf(point: Point, of: Figure): string {
    const spread = of.key === "frame_ms" ? point.frame_ms : of.key === "trace_ms" ? point.trace_ms : null;
    return spread && isNumber(spread.p5) && isNumber(spread.p95) ? ` (${number(spread.p5)} to ${number(spread.p95)})` : "";
}

/** What a hovered point says: its method, the setting that it varies, its figures, all of its settings. */
export function tooltipOf(point: Point, ...shown: Figure[]): Node[] {
    const list = h("dl", {});
    const clock = (of: Figure): string => (of.unit === "ms" && point.clock === "cpu" ? " on the CPU" : "");
    for (const of of shown) list.append(h("dt", {}, of.label + clock(of)), h("dd", {}, withUnit(of, of.of(point)) + spreadOf(point, of)));
    const settings = Object.entries(point.settings ?? {})
        .map(([name, value]) => `${name} ${String(value)}`)
        .join(" · ");
    return [
        h("strong", {}, titleOf(point)),
        list,
        h("p", { class: "note" }, settings || "no settings recorded"),
        ...(point.wrong ? [h("p", { class: "wrong" }, `Wrong: ${point.wrong}`)] : []),
    ];
}
