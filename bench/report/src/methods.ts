// A colour and a shape for each method: the same everywhere, told apart without colour, too.
import { svg } from "./dom";

const kKnown = ["ours", "ours-grid", "b0plus", "b0plus-octree", "b0", "wang", "path tracer", "ddgi", "ddgi-placed", "sh-grid", "path tracer filtered"];
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

/** Styles of all methods of a run, the known ones always alike. */
export function methodStyles(methods: string[]): Map<string, MethodStyle> {
    const order = [...kKnown, ...methods.filter((method) => !kKnown.includes(method))];
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
