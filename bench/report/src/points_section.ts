// Every point that was measured, to sort and to filter.
import { h, section, segments } from "./dom";
import { figure, figures, headOf, measured, type Figure } from "./figures";
import { fold } from "./fold";
import { counted, plain } from "./format";
import { glyph, methodName, titleOf, type MethodStyle } from "./methods";
import { nameOf, points, type Point, type Scene } from "./results";
import type { Store } from "./store";
import { table, type Column } from "./table";

const kOverview = [
    "frame_ms",
    "trace_ms",
    "rays.reads_mean",
    "rays.wrong",
    "rays.wrong_02",
    "error.glossy.relmse",
    "error.diffuse.relmse",
    "error.beauty.flip",
    "bytes.total",
    "bake_s",
    "place_s",
];

function column(of: Figure): Column<Point> {
    return { head: headOf(of), title: of.label, numeric: true, sortBy: (point) => of.of(point), show: (point) => of.show(of.of(point)) };
}

/** Settings that some point has, in the order in which they first appear. */
function settingColumns(all: Point[]): Column<Point>[] {
    const names = [...new Set(all.flatMap((point) => Object.keys(point.settings ?? {})))];
    return names.map((name) => {
        const of = (point: Point): unknown => point.settings?.[name] ?? null;
        return {
            head: name,
            numeric: all.every((point) => of(point) === null || typeof of(point) === "number"),
            sortBy: (point) => {
                const value = of(point);
                return value === null || typeof value === "number" ? value : plain(value);
            },
            show: (point) => plain(of(point)),
        };
    });
}

export function pointsSection(scene: Scene, styles: Map<string, MethodStyle>, store: Store): HTMLElement {
    const all = points(scene);
    const pickButton = (point: Point): HTMLElement =>
        h(
            "button",
            { type: "button", class: "link", title: point.id, click: (event: MouseEvent) => (event.stopPropagation(), store.pick(point)) },
            glyph(styles.get(point.method)),
            h("span", { class: "clip" }, methodName(point.method)),
        );
    const first: Column<Point>[] = [
        { head: "method", sortBy: (point) => methodName(point.method), show: pickButton },
        {
            head: "setting",
            title: "The knob that this point varies from the default",
            sortBy: nameOf,
            show: (point) =>
                h(
                    "span",
                    { class: "setting" },
                    h("span", { class: "clip", title: nameOf(point) }, nameOf(point)),
                    point.wrong ? h("span", { class: "tag wrong", title: point.wrong }, "wrong image") : null,
                ),
        },
    ];
    const groups: Record<string, () => Column<Point>[]> = {
        overview: () => measured(all, kOverview.map(figure)).map(column),
        ...Object.fromEntries(
            ["time", "rays", "error", "memory"].map((group) => [
                group,
                () =>
                    measured(
                        all,
                        figures.filter((of) => of.group === group),
                    ).map(column),
            ]),
        ),
        settings: () => settingColumns(all),
    };
    const columnsOf = (group: string): Column<Point>[] => [...first, ...(groups[group]?.() ?? [])];
    const grid = table("All points", columnsOf("overview"), all, { picked: (point) => store.pick(point) });
    grid.element.classList.add("tall");

    const filter = h("input", { type: "search", placeholder: "e.g. ours probes", size: 18, input: () => update() });
    const count = h("span", { class: "note", role: "status" });
    const summary = h("summary", {});
    const update = (): void => {
        const words = filter.value.toLowerCase().split(/\s+/).filter(Boolean);
        const rows = all.filter((point) => {
            const text = `${point.id} ${titleOf(point)} ${point.wrong ? "wrong" : ""} ${Object.entries(point.settings ?? {})
                .flat()
                .join(" ")}`.toLowerCase();
            return store.visible(point) && words.every((word) => text.includes(word));
        });
        grid.setRows(rows);
        count.textContent = `${rows.length} of ${counted(all.length, "point")}`;
        summary.textContent = `Table of ${counted(rows.length, "row")}, one a point`;
        mark();
    };
    const mark = (): void => {
        grid.element.querySelector("tr.picked")?.classList.remove("picked");
        if (store.picked) grid.rowOf(store.picked)?.classList.add("picked");
    };
    store.on(["methods"], update);
    update();

    const choice = segments(
        "Columns",
        Object.keys(groups).map((group) => ({ value: group, label: group })),
        "overview",
        (group) => {
            grid.setColumns(columnsOf(group));
            mark();
        },
    );
    const field = h("label", { class: "field" }, h("span", {}, "Filter"), filter);
    const controls = h("div", { class: "controls" }, choice.element, field, count);
    const folded = fold(summary, controls, grid.element);
    store.on(["pick"], () => {
        mark();
        if (store.picked) folded.open = true; // so that its row is seen
    });
    return section("points", "Every point", folded);
}
