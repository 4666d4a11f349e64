// Ours beside theirs at equal error, probes, time and memory; what each knob's accuracy costs; where methods break.
import { h, section } from "./dom";
import { figures } from "./figures";
import { ratio } from "./format";
import { glyph, type MethodStyle } from "./methods";
import { isNumber, nameOf, points, type Equal, type Point, type Price, type Scene } from "./results";
import type { Store } from "./store";
import { table, type Column } from "./table";

const kEven = 0.03; // a ratio within it of 1 is neither a win nor a loss

/** Ours / theirs, lower is better; the arrow says it without colour. */
function verdict(value: number | null | undefined): HTMLElement | string {
    if (!isNumber(value)) return ratio(value);
    const even = Math.abs(value - 1) <= kEven;
    const kind = even ? "even" : value < 1 ? "win" : "loss";
    const arrow = { even: "=", win: "▼", loss: "▲" }[kind];
    const said = { even: "as much", win: "less", loss: "more" }[kind];
    return h("span", { class: kind, title: `${said} than theirs` }, h("span", { "aria-hidden": "true", class: "arrow" }, arrow), ratio(value));
}

function numberOf(value: unknown): number | null {
    return isNumber(value) ? value : null;
}

export function analysisSection(scene: Scene, styles: Map<string, MethodStyle>, store: Store): HTMLElement {
    const byId = new Map(points(scene).map((point) => [point.id, point]));
    const pointCell = (id: string): Node | string => {
        const point = byId.get(id);
        if (!point) return id;
        const text = `${point.method}, ${nameOf(point)}`;
        return h(
            "button",
            { type: "button", class: "link", title: id, click: () => store.pick(point), mouseenter: () => store.hover(point), mouseleave: () => store.hover(null) },
            glyph(styles.get(point.method)),
            h("span", { class: "clip" }, text),
        );
    };
    const pointText = (id: string): string => {
        const point: Point | undefined = byId.get(id);
        return point ? `${point.method}, ${nameOf(point)}` : id;
    };
    const errorName = (key: string | undefined): string => figures.find((of) => of.key === `error.${key}` || of.key === key)?.label ?? key ?? "";

    const ratioColumn = (head: string, key: string): Column<Equal> => ({
        head,
        title: `${head}: ours / theirs; below 1 ours needs or has less`,
        numeric: true,
        sortBy: (row) => numberOf(row.ratio?.[key]),
        show: (row) => verdict(row.ratio?.[key]),
    });
    const equalColumns: Column<Equal>[] = [
        { head: "at equal", sortBy: (row) => row.what, show: (row) => (row.error_key ? `${row.what} (${errorName(row.error_key)})` : row.what) },
        { head: "ours", sortBy: (row) => pointText(row.ours), show: (row) => pointCell(row.ours) },
        { head: "theirs", sortBy: (row) => pointText(row.theirs), show: (row) => pointCell(row.theirs) },
        ratioColumn("time", "time"),
        ratioColumn("error", "error"),
        ratioColumn("memory", "memory"),
        ratioColumn("wrong rays", "wrong_rays"),
        { head: "in words", sortBy: (row) => row.sentence ?? null, show: (row) => row.sentence ?? "" },
    ];
    const priceRatio = (head: string, key: keyof Price, title: string): Column<Price> => ({
        head,
        title,
        numeric: true,
        sortBy: (row) => numberOf(row[key]),
        show: (row) => ratio(row[key]),
    });
    const priceColumns: Column<Price>[] = [
        { head: "knob", sortBy: (row) => row.knob, show: (row) => row.knob },
        { head: "from", sortBy: (row) => pointText(row.from), show: (row) => pointCell(row.from) },
        { head: "to", sortBy: (row) => pointText(row.to), show: (row) => pointCell(row.to) },
        priceRatio("error", "error_ratio", "error of `to` / error of `from`"),
        priceRatio("time", "time_ratio", "time of `to` / time of `from`"),
        priceRatio("memory", "memory_ratio", "memory of `to` / memory of `from`"),
        priceRatio("halving costs", "halving_costs_time", "the time that halving the error by this knob costs, as a factor"),
        { head: "in words", sortBy: (row) => row.sentence ?? null, show: (row) => row.sentence ?? "" },
    ];
    const equal = scene.analysis?.equal ?? [];
    const prices = scene.analysis?.prices ?? [];
    const breaks = scene.analysis?.breaks ?? [];
    const words = (element: HTMLElement): HTMLElement => (element.classList.add("words"), element);
    const none = (what: string): HTMLElement => h("p", { class: "note" }, `This run has no ${what}.`);
    return section(
        "answers-scene",
        "Ours against theirs",
        h("p", { class: "lead" }, "Ratios are ours / theirs: ▼ below 1 ours needs less or errs less, ▲ above 1 more."),
        equal.length > 0 ? words(table("At equal error, probes, time and memory", equalColumns, equal).element) : none("pairs to compare"),
        h("h3", {}, "Price list"),
        prices.length > 0 ? words(table("What each knob costs", priceColumns, prices).element) : none("prices: a knob needs two points"),
        h("h3", {}, "Where each method breaks"),
        breaks.length > 0
            ? h("ul", { class: "breaks" }, ...breaks.map((one) => h("li", {}, glyph(styles.get(one.method)), h("strong", {}, one.method), " ", one.sentence)))
            : none("method that broke"),
    );
}
