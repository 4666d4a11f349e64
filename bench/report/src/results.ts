// results.json, schema 2 (docs/formats.md), as it is read here. Anything may be missing: what was not measured is null or left out.

export interface Spread {
    median: number;
    p5: number;
    p95: number;
    frames: number;
}

export interface Point {
    id: string;
    method: string;
    knob: string;
    value: string;
    settings?: Record<string, unknown>;
    probe_set?: string;
    trace_ms?: Partial<Spread> | null;
    frame_ms?: Partial<Spread> | null;
    passes_ms?: Record<string, unknown> | null;
    rays?: Record<string, unknown> | null;
    error?: Record<string, Record<string, unknown> | null> | null;
    bytes?: Record<string, unknown> | null;
    bake_s?: number | null;
    place_s?: number | null;
    bake_peak_mb?: number | null;
    wrong?: string | null;
    clock?: string; // whose time it is: "device" or "cpu"
    probes?: number | null;
    images?: Record<string, string> | null;
}

export interface ProbeSet {
    method?: string;
    seconds?: number | null;
    grid?: [number, number, number] | null; // probes along x, y, z
    coverage?: { rays?: number | null; area?: number | null } | null;
    probes?: { position: [number, number, number]; why?: string }[];
}

export interface Equal {
    what: string;
    error_key?: string | null;
    cost_key?: string | null; // what the cheapest of equal error was chosen by
    method?: string; // theirs
    ours: string | null; // null: no setting of ours is good or cheap enough
    theirs: string | null;
    ratio?: Record<string, number | null> | null;
    sentence?: string;
}

export interface Price {
    knob: string;
    error_key?: string | null;
    from: string;
    to: string;
    error_ratio?: number | null;
    time_ratio?: number | null;
    trace_ratio?: number | null;
    reads_ratio?: number | null;
    memory_ratio?: number | null;
    halving_costs_time?: number | null;
    halving_costs_memory?: number | null;
    sentence?: string;
}

export interface Scene {
    name: string;
    source?: string;
    triangles?: number | null;
    width?: number;
    height?: number;
    camera?: { eye?: number[]; target?: number[]; fov_degrees?: number };
    reference?: {
        spp?: number;
        seconds?: number | null;
        estimated_relmse?: Record<string, number | null>;
        images?: Record<string, string> | null;
    };
    bounds?: { min: [number, number, number]; max: [number, number, number] };
    plan?: { segments?: [number, number, number, number][] } | null;
    probe_sets?: Record<string, ProbeSet>;
    points?: Point[];
    analysis?: { equal?: Equal[]; prices?: Price[]; breaks?: { method: string; id?: string; sentence: string }[] } | null;
}

export interface GpuFrame {
    name: string;
    clock_mhz?: number[] | null; // least, median, most
    passes_ms: Record<string, number>;
}

export interface GpuRays {
    tracer: string;
    cold: boolean;
    in_order: number; // million rays a second
    shuffled: number;
}

/** What bench/gpu/run.sh measured elsewhere. */
export interface GpuRun {
    device?: string;
    driver?: string;
    size?: string;
    wrong?: string[]; // its parts that failed
    frames?: GpuFrame[];
    rays?: GpuRays[];
}

export interface Results {
    schema: number;
    version?: string;
    commands?: string[];
    started?: string;
    seconds?: number | null;
    machine?: Record<string, unknown>;
    device?: Record<string, unknown>;
    scenes?: Scene[];
    answers?: string[];
    gpu?: GpuRun;
}

export const kSchema = 2;

/** The results that stand in this page. Throws a sentence that a person can act on. */
export function loadResults(): Results {
    const element = document.getElementById("results");
    if (!element)
        throw new Error("This page holds no results: it is the empty template. `sconce bench` writes a filled one to report/index.html.");
    const results = JSON.parse(element.textContent ?? "") as Results;
    if (results.schema !== kSchema)
        throw new Error(`These results have schema ${results.schema}, this page reads schema ${kSchema}: run \`sconce bench\` again.`);
    return results;
}

export function isNumber(value: unknown): value is number {
    return typeof value === "number" && Number.isFinite(value);
}

/** A point's setting that differs from the scene's default point of the same method, as `knob value`. */
export function nameOf(point: Point): string {
    return point.knob === "default" || !point.knob ? "default" : `${point.knob} ${point.value}`;
}

/** `6 × 3 × 3`; empty where the probes are no grid. */
export function gridShape(set: ProbeSet | undefined): string {
    return set?.grid?.join(" × ") ?? "";
}

export function points(scene: Scene): Point[] {
    return scene.points ?? [];
}

export function methodsOf(scene: Scene): string[] {
    return [...new Set(points(scene).map((point) => point.method))];
}

/** The files of images that a point has; empty when it has none. */
export function imagesOf(owner: { images?: Record<string, string> | null } | null | undefined): Record<string, string> {
    return owner?.images ?? {};
}
