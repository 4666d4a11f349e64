// Every figure of a point that plots and tables can show: one table, from which axes, columns and tooltips are made.
import { megabytes, number, percent, plain } from "./format";
import { isNumber, type Point } from "./results";

export interface Figure {
    key: string;
    label: string;
    short: string; // as a column's head
    unit: string;
    group: "time" | "rays" | "error" | "memory";
    better?: "lower" | "higher";
    show(value: unknown): string; // in `unit`
    axis: number; // an axis shows value * axis
    of(point: Point): number | null;
}

function path(point: Point, key: string): number | null {
    let value: unknown = point;
    for (const part of key.split("."))
        value = typeof value === "object" && value !== null ? (value as Record<string, unknown>)[part] : undefined;
    if (typeof value === "object" && value !== null) value = (value as Record<string, unknown>).median;
    return isNumber(value) ? value : null;
}

type Rest = Partial<Pick<Figure, "better" | "of">>;

function time(key: string, label: string, short = label, unit = "ms", rest: Rest = {}): Figure {
    return { key, label, short, unit, group: "time", better: "lower", show: number, axis: 1, of: (point) => path(point, key), ...rest };
}
function share(key: string, label: string, short: string, better: Figure["better"], of?: Figure["of"]): Figure {
    return { key, label, short, unit: "%", group: "rays", better, show: percent, axis: 100, of: of ?? ((point) => path(point, key)) };
}
function count(key: string, label: string, short: string, better?: Figure["better"]): Figure {
    return { key, label, short, unit: "", group: "rays", better, show: number, axis: 1, of: (point) => path(point, key) };
}
function bytes(key: string, label: string, short: string): Figure {
    return {
        key,
        label,
        short,
        unit: "MB",
        group: "memory",
        better: "lower",
        show: megabytes,
        axis: 1e-6,
        of: (point) => path(point, key),
    };
}

const kMetrics: [string, string][] = [
    ["relmse", "relMSE"],
    ["mse", "MSE"],
    ["flip", "FLIP"],
    ["mean", "mean over the reference's"],
];
const errors: Figure[] = ["glossy", "diffuse", "beauty"].flatMap((layer) =>
    kMetrics.map(([metric, name]): Figure => {
        const key = `error.${layer}.${metric}`;
        return {
            key,
            label: `${name} of ${layer}`,
            short: `${layer} ${name}`,
            unit: "",
            group: "error",
            better: metric === "mean" ? undefined : "lower",
            show: number,
            axis: 1,
            of: (point) => path(point, key),
        };
    }),
);

/** The share of rays that is not right, of a figure that says how many are; null for what has no rays. */
function wrongRays(right: string): (point: Point) => number | null {
    return (point) => {
        const share = path(point, right);
        return share === null ? null : 1 - share;
    };
}

export const figures: Figure[] = [
    time("frame_ms", "frame time"),
    time("trace_ms", "trace time"),
    time("place_s", "placement time", "placement", "s"),
    time("bake_s", "bake time", "bake", "s"),
    count("rays.reads_mean", "texel reads a ray", "reads a ray", "lower"),
    count("rays.reads_p95", "texel reads a ray, 95th percentile", "reads p95", "lower"),
    count("rays.reads_max", "texel reads a ray, most", "reads max", "lower"),
    count("rays.index_reads_mean", "octree reads a ray", "octree reads", "lower"),
    count("rays.handoffs_mean", "hand-offs a ray", "hand-offs"),
    share("rays.wrong", "wrong rays (not within 1 %)", "wrong 1 %", "lower", wrongRays("rays.right_1")),
    share("rays.wrong_02", "wrong rays (not within 0.2 %)", "wrong 0.2 %", "lower", wrongRays("rays.right_02")),
    share("rays.right_1", "right rays, within 1 % of the diagonal", "right 1 %", "higher"),
    share("rays.right_02", "right rays, within 0.2 % of the diagonal", "right 0.2 %", "higher"),
    share("rays.right_1_unsure", "standard error of the right rays within 1 %, by viewpoint", "right 1 % +-", "lower"),
    share("rays.right_02_unsure", "standard error of the right rays within 0.2 %, by viewpoint", "right 0.2 % +-", "lower"),
    share("rays.false", "false hits", "false", "lower"),
    share("rays.leak", "leaks", "leak", "lower"),
    share("rays.unresolved", "unresolved rays", "unresolved", "lower"),
    count("rays.count", "rays traced", "rays"),
    ...errors,
    {
        key: "probes",
        label: "probes",
        short: "probes",
        unit: "",
        group: "memory",
        better: "lower",
        show: plain,
        axis: 1,
        of: (point) => path(point, "probes"),
    },
    bytes("bytes.total", "memory", "memory"),
    bytes("bytes.distance", "distance maps", "distance"),
    bytes("bytes.normals", "normal maps", "normals"),
    bytes("bytes.radiance", "radiance maps", "radiance"),
    bytes("bytes.irradiance", "irradiance maps", "irradiance"),
    bytes("bytes.index", "octree", "index"),
    {
        key: "bake_peak_mb",
        label: "peak host memory of the bake",
        short: "bake peak",
        unit: "MB",
        group: "memory",
        better: "lower",
        show: number,
        axis: 1,
        of: (point) => path(point, "bake_peak_mb"),
    },
];

const byKey = new Map(figures.map((figure) => [figure.key, figure]));

/** Misuse: a key that is not in the table throws. */
export function figure(key: string): Figure {
    const found = byKey.get(key);
    if (!found) throw new Error(`no figure ${key}`);
    return found;
}

export function withUnit(of: Figure, value: unknown): string {
    const text = of.show(value);
    return isNumber(value) && of.unit ? `${text} ${of.unit}` : text;
}

/** Those of the figures that some point has. */
export function measured(points: Point[], candidates: Figure[]): Figure[] {
    return candidates.filter((of) => points.some((point) => of.of(point) !== null));
}

export function headOf(of: Figure): string {
    return of.unit ? `${of.short}, ${of.unit}` : of.short;
}

/** What a plot's upright axis can show. */
export const errorFigures = [...errors, ...["rays.wrong", "rays.false", "rays.leak", "rays.unresolved"].map(figure)];
