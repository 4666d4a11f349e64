// Ours beside theirs at equal error, probes, time and memory; what each knob's accuracy costs; where methods break.
import { h, section, select } from "./dom";
import { figures } from "./figures";
import { counted, kNone, ratio } from "./format";
import { glyph, methodName, titleOf, type MethodStyle } from "./methods";
import { outcomeOf } from "./outcome";
import { isNumber, points, type Equal, type Point, type Price, type Scene } from "./results";
import type { Store } from "./store";
import { table, type Column } from "./table";

/** Ours / theirs, lower is better; the arrow says it without colour. */
function verdict(value: unknown): HTMLElement | string {
    if (!isNumber(value)) return ratio(value);
    const kind = outcomeOf(value);
    const arrow = { even: "=", win: "▼", loss: "▲" }[kind];
    const said = { even: "as much", win: "less", loss: "more" }[kind];
    return h(
        "span",
        { class: kind, title: `${said} than theirs` },
        h("span", { "aria-hidden": "true", class: "arrow" }, arrow),
        ratio(value),
    );
}

const kCostNames: Record<string, string> = { frame_ms: "frame time", trace_ms: "trace time", reads: "reads", bytes: "memory" };
const kRatios: [string, string][] = [
    ["time", "frame time"],
    ["trace", "trace time"],
    ["reads", "reads"],
    ["error", "error"],
    ["memory", "memory"],
    ["wrong_rays", "wrong rays, 1 %"],
    ["probes", "probes"],
];
const kPrices: [keyof Price, string, string][] = [
    ["error_ratio", "error", "error of `to` / error of `from`"],
    ["time_ratio", "frame time", "frame time of `to` / frame time of `from`"],
    ["trace_ratio", "trace time", "trace time of `to` / trace time of `from`"],
    ["reads_ratio", "reads", "reads a ray of `to` / of `from`"],
    ["memory_ratio", "memory", "memory of `to` / memory of `from`"],
    ["halving_costs_time", "½ error: time", "the factor on the time when the error is halved by this knob"],
    ["halving_costs_memory", "½ error: memory", "the factor on the memory when the error is halved by this knob"],
];

function errorName(row: { error_key?: string | null }): string {
    const key = row.error_key === "wrong_rays" ? "rays.wrong" : (row.error_key ?? "");
    return figures.find((of) => of.key === `error.${key}` || of.key === key || of.key === `rays.${key}`)?.short ?? key;
}

/**
 * A table with a choice for each property by which its rows can be narrowed down.
 * @param silent  whether a row's cells say nothing without its sentence, which is then shown always
 */
function filtered<T extends { sentence?: string }>(
    label: string,
    columns: Column<T>[],
    rows: T[],
    properties: [string, (row: T) => string][],
    silent: (row: T) => boolean = () => false,
): HTMLElement {
    let inWords = false;
    const grid = table(label, columns, rows, { below: (row) => (inWords || silent(row) ? (row.sentence ?? "") : "") });
    grid.element.classList.add("words");
    const chosen = properties.map(() => "");
    const count = h("span", { class: "note", role: "status" });
    const update = (): void => {
        const kept = rows.filter((row) => properties.every(([, of], index) => !chosen[index] || of(row) === chosen[index]));
        grid.setRows(kept);
        count.textContent = `${kept.length} of ${counted(rows.length, "row")}`;
    };
    const controls = properties.flatMap(([name, of], index) => {
        const values = [...new Set(rows.map(of))].filter(Boolean);
        if (values.length < 2) return [];
        return [
            select(
                name,
                [{ value: "", label: "all" }, ...values.map((value) => ({ value, label: value }))],
                "",
                (value) => ((chosen[index] = value), update()),
            ),
        ];
    });
    const check = h("input", { type: "checkbox", change: () => ((inWords = check.checked), update()) });
    const words = h("label", { class: "field" }, check, "in words");
    update();
    return h("div", { class: "stack" }, h("div", { class: "controls" }, ...controls, words, count), grid.element);
}

export function analysisSection(scene: Scene, styles: Map<string, MethodStyle>, store: Store): HTMLElement {
    const byId = new Map(points(scene).map((point) => [point.id, point]));
    const nameFor = (id: string | null, none: string): string => {
        const point: Point | undefined = byId.get(id ?? "");
        return point ? titleOf(point) : (id ?? none);
    };
    const pointCell = (id: string | null, none = kNone): Node | string => {
        const point = byId.get(id ?? "");
        if (!point) return nameFor(id, none);
        const name = h("span", { class: "clip", title: nameFor(id, none) }, nameFor(id, none));
        return h(
            "button",
            {
                type: "button",
                class: "link",
                click: () => store.pick(point),
                mouseenter: () => store.hover(point),
                mouseleave: () => store.hover(null),
            },
            glyph(styles.get(point.method)),
            name,
        );
    };
    const pointColumn = <T>(head: string, idOf: (row: T) => string | null, none = kNone): Column<T> => ({
        head,
        sortBy: (row) => nameFor(idOf(row), none),
        show: (row) => pointCell(idOf(row), none),
    });
    const ratioColumn = <T>(head: string, title: string, of: (row: T) => unknown, show: (value: unknown) => Node | string): Column<T> => ({
        head,
        title,
        numeric: true,
        sortBy: (row) => (isNumber(of(row)) ? (of(row) as number) : null),
        show: (row) => show(of(row)),
    });
    const present = <T>(rows: T[], columns: Column<T>[]): Column<T>[] =>
        columns.filter((column) => rows.some((row) => column.sortBy(row) !== null));
    const equal = scene.analysis?.equal ?? [];
    const equalColumns = present(equal, [
        {
            head: "at equal",
            sortBy: (row) => row.what,
            show: (row) => row.what + (row.what === "error" && row.cost_key ? `, least ${kCostNames[row.cost_key] ?? row.cost_key}` : ""),
        },
        { head: "judged by", title: "the error that is compared", sortBy: (row) => errorName(row) || null, show: errorName },
        pointColumn("ours", (row) => row.ours, "no setting of ours"),
        pointColumn("theirs", (row) => row.theirs),
        ...kRatios.map(([key, head]) =>
            ratioColumn<Equal>(head, `${head}: ours / theirs; below 1 ours takes or has less`, (row) => row.ratio?.[key], verdict),
        ),
    ]);
    const prices = scene.analysis?.prices ?? [];
    const priceColumns = present(prices, [
        { head: "knob", sortBy: (row) => row.knob, show: (row) => row.knob },
        { head: "judged by", title: "the error that is compared", sortBy: (row) => errorName(row) || null, show: errorName },
        pointColumn("from", (row) => row.from),
        pointColumn("to", (row) => row.to),
        ...kPrices.map(([key, head, title]) => ratioColumn<Price>(head, title, (row) => row[key], ratio)),
    ]);
    const breaks = scene.analysis?.breaks ?? [];
    const none = (what: string): HTMLElement => h("p", { class: "note" }, `This run has no ${what}.`);
    return section(
        "answers-scene",
        "Ours against theirs",
        h("p", { class: "lead" }, "Ratios are ours / theirs: ▼ below 1 ours takes less or errs less, ▲ above 1 more."),
        equal.length > 0
            ? filtered(
                  "At equal error, probes, time and memory",
                  equalColumns,
                  equal,
                  [
                      ["At equal", (row) => row.what],
                      ["Judged by", errorName],
                      ["Theirs", (row) => methodName(row.method ?? byId.get(row.theirs ?? "")?.method ?? "")],
                  ],
                  (row) => row.ours === null,
              )
            : none("pairs to compare"),
        h("h3", {}, "Price list"),
        prices.length > 0
            ? filtered("What each knob costs", priceColumns, prices, [
                  ["Knob varied", (row) => row.knob],
                  ["Prices by", errorName],
              ])
            : none("prices: a knob needs two points"),
        h("h3", {}, "Where each method breaks"),
        breaks.length > 0
            ? h(
                  "ul",
                  { class: "breaks" },
                  ...breaks.map((one) =>
                      h(
                          "li",
                          {},
                          byId.has(one.id ?? "") ? pointCell(one.id ?? null) : h("strong", {}, glyph(styles.get(one.method)), methodName(one.method)),
                          h("span", {}, one.sentence),
                      ),
                  ),
              )
            : none("method that broke"),
    );
}
