// What a kit measured on a machine with a graphics card, beside this run's own device.
import { h, section } from "./dom";
import { kNone, number, plain, ratio } from "./format";
import { isNumber, points, type GpuFrame, type GpuRays, type GpuRun, type Results, type Scene } from "./results";
import { table, type Column } from "./table";

const kHostPasses = ["G-buffer", "direct light", "compose"]; // what a renderer has anyway

interface Row {
    name: string;
    clock: string;
    passes: Record<string, number>;
}

function indirectOf(row: Row): number {
    return Object.entries(row.passes).reduce((sum, [pass, ms]) => (kHostPasses.includes(pass) ? sum : sum + ms), 0);
}

function rowOf(frame: GpuFrame): Row {
    const clock = frame.clock_mhz?.[1];
    return { name: frame.name.replaceAll("_", " "), clock: isNumber(clock) ? `${clock} MHz` : kNone, passes: frame.passes_ms };
}

/** Our default point of the scene, which this run has measured on its device. */
function ownRow(results: Results, scene: Scene): Row[] {
    const own = points(scene).find((point) => point.method === "ours" && point.knob === "default");
    const passes = Object.entries(own?.passes_ms ?? {}).filter((entry): entry is [string, number] => isNumber(entry[1]));
    if (passes.length === 0) return [];
    const size = scene.width && scene.height ? ` at ${scene.width}x${scene.height}` : "";
    return [{ name: `${scene.name}${size}, this run: ${plain(results.device?.name)}`, clock: kNone, passes: Object.fromEntries(passes) }];
}

function framesTable(rows: Row[]): HTMLElement {
    const passes = [...new Set(rows.flatMap((row) => Object.keys(row.passes)))];
    const columns: Column<Row>[] = [
        { head: "Frame", sortBy: (row) => row.name, show: (row) => row.name },
        {
            head: "indirect light, ms",
            title: `all but ${kHostPasses.join(", ")}`,
            numeric: true,
            sortBy: indirectOf,
            show: (row) => number(indirectOf(row)),
        },
        ...passes.map(
            (pass): Column<Row> => ({
                head: pass,
                numeric: true,
                sortBy: (row) => row.passes[pass] ?? null,
                show: (row) => number(row.passes[pass]),
            }),
        ),
        { head: "clock", numeric: true, sortBy: (row) => row.clock, show: (row) => row.clock },
    ];
    return table("Milliseconds of frames on a graphics card", columns, rows).element;
}

function raysTable(all: GpuRays[]): HTMLElement {
    const yardstick = (row: GpuRays): GpuRays | undefined => all.find((other) => other.tracer === "b0plus-octree" && other.cold === row.cold);
    const over = (row: GpuRays, order: "in_order" | "shuffled"): number | null => {
        const theirs = yardstick(row)?.[order];
        return theirs ? theirs / row[order] : null; // times, of rates
    };
    const column = (head: string, value: (row: GpuRays) => number | null, show: (value: unknown) => string): Column<GpuRays> => ({
        head,
        numeric: true,
        sortBy: value,
        show: (row) => show(value(row)),
    });
    const columns: Column<GpuRays>[] = [
        { head: "Tracer", sortBy: (row) => row.tracer, show: (row) => `${row.tracer}${row.cold ? ", cold caches" : ""}` },
        column("million rays/s, in order", (row) => row.in_order, number),
        column("shuffled", (row) => row.shuffled, number),
        column("time over B0+ of the same probes, in order", (row) => over(row, "in_order"), ratio),
        column("shuffled", (row) => over(row, "shuffled"), ratio),
    ];
    return table("Rays a second on a graphics card", columns, all).element;
}

export function gpuSection(run: GpuRun, results: Results, scene: Scene): HTMLElement {
    const wrong = run.wrong ?? [];
    return section(
        "gpu",
        "On a graphics card",
        h("p", { class: "note" }, [run.device, run.driver, run.size].filter(Boolean).join(" · ")),
        wrong.length > 0 ? h("p", { class: "wrong" }, `Wrong there: ${wrong.join(", ")}.`) : null,
        framesTable([...(run.frames ?? []).map(rowOf), ...ownRow(results, scene)]),
        (run.rays ?? []).length > 0 ? raysTable(run.rays ?? []) : null,
    );
}
