// A name, a colour and a shape for each method: the same everywhere, told apart without colour, too.
import { svg } from "./dom";
import { nameOf, type Point } from "./results";

const kKnown: [string, string][] = [
    ["ours", "Sconce"],
    ["ours-grid", "Sconce on a grid"],
    ["b0plus", "B0+"],
    ["b0plus-octree", "B0+ on Sconce's probes"],
    ["b0", "B0"],
    ["wang", "W'"],
    ["path tracer", "path tracer"],
    ["ddgi", "DDGI"],
    ["ddgi-placed", "DDGI on Sconce's probes"],
    ["sh-grid", "SH grid"],
    ["path tracer filtered", "filtered path tracer"],
];
const kNames = new Map(kKnown);
const kColours = 11; // --method-0 ... in style.css

// Outlines in a box from -1 to 1.
const kShapes = [
    "M1 0A1 1 0 1 1-1 0A1 1 0 1 1 1 0Z",
    "M0-1.15L1.15 0L0 1.15L-1.15 0Z",
    "M-.9-.9H.9V.9H-.9Z",
    "M0-1.1L1.1.9H-1.1Z",
    "M0 1.1L1.1-.9H-1.1Z",
    "M-.35-1H.35V-.35H1V.35H.35V1H-.35V.35H-1V-.35H-.35Z",
    "M0-1.1L1.05-.34L.65.9H-.65L-1.05-.34Z",
    "M-1-.5L-.5-1L0-.5L.5-1L1-.5L.5 0L1 .5L.5 1L0 .5L-.5 1L-1 .5L-.5 0Z",
    "M-1.1-.5H1.1V.5H-1.1Z",
    "M-.5-1.1H.5V1.1H-.5Z",
    "M-1-1L1-1L-1 1L1 1Z",
];

export interface MethodStyle {
    colour: string; // a custom property
    outline: string; // path data
}

/** As a person would call it; of one that isn't known, as the results do. */
export function methodName(method: string): string {
    return kNames.get(method) ?? method;
}

/** A point's method and setting. */
export function titleOf(point: Point): string {
    return `${methodName(point.method)}, ${nameOf(point)}`;
}

/** Whether it is another's way to do what ours does. A path tracer isn't: given paths enough, it is the reference. */
export function isOpponent(method: string): boolean {
    return !["ours", "ours-grid", "path tracer", "path tracer filtered"].includes(method);
}

/** Styles of all methods of a run, the known ones always alike. */
export function methodStyles(methods: string[]): Map<string, MethodStyle> {
    const order = [...new Set([...kNames.keys(), ...methods])];
    const style = (index: number): MethodStyle => ({
        colour: `--method-${index % kColours}`,
        outline: kShapes[index % kShapes.length] as string,
    });
    return new Map(order.map((method, index) => [method, style(index)]));
}

/** The mark of a method beside its name. */
export function glyph(style: MethodStyle | undefined): SVGSVGElement {
    const path = svg("path", { d: style?.outline ?? kShapes[0], fill: `var(${style?.colour ?? "--ink"})` });
    return svg("svg", { class: "glyph", viewBox: "-1.3 -1.3 2.6 2.6", "aria-hidden": "true" }, path);
}
