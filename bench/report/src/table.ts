// A table whose columns sort when their heads are pressed.
import { h } from "./dom";

export interface Column<T> {
    head: string;
    title?: string;
    numeric?: boolean;
    sortBy(row: T): number | string | null; // null: not measured, comes last whichever way it sorts
    show(row: T): Node | string;
}

export interface Table<T> {
    element: HTMLElement; // scrolls sideways by itself
    setRows(rows: T[]): void;
    setColumns(columns: Column<T>[]): void;
    rowOf(item: T): HTMLTableRowElement | undefined;
}

function compare(a: number | string | null, b: number | string | null, way: number): number {
    if (a === null || b === null) return (a === null ? 1 : 0) - (b === null ? 1 : 0);
    if (typeof a === "number" && typeof b === "number") return way * (a - b);
    return way * String(a).localeCompare(String(b), "en", { numeric: true });
}

export interface TableOptions<T> {
    picked?: (row: T) => void; // called with a row that is clicked
    below?: (row: T) => string; // a line under each row
}

/** @param label  for screen readers */
export function table<T>(label: string, firstColumns: Column<T>[], firstRows: T[], { picked, below }: TableOptions<T> = {}): Table<T> {
    let columns = firstColumns;
    let rows = firstRows;
    let sorted: Column<T> | undefined;
    let way = 1;
    let made = new Map<T, HTMLTableRowElement>();
    const headRow = h("tr");
    const body = h("tbody");
    const element = h(
        "div",
        { class: "scroll", tabindex: 0, role: "region", "aria-label": label },
        h("table", {}, h("thead", {}, headRow), body),
    );

    function fillHead(): void {
        headRow.replaceChildren(
            ...columns.map((column) => {
                const order = column === sorted ? (way > 0 ? "ascending" : "descending") : "none";
                const press = (): void => {
                    way = column === sorted ? -way : 1;
                    sorted = column;
                    fillHead();
                    fillBody();
                    headRow.querySelectorAll("button")[columns.indexOf(column)]?.focus();
                };
                return h(
                    "th",
                    { scope: "col", "aria-sort": order, class: column.numeric ? "number" : null, title: column.title },
                    h("button", { type: "button", click: press }, column.head),
                );
            }),
        );
    }
    function fillBody(): void {
        const by = sorted;
        const ordered = by ? [...rows].sort((a, b) => compare(by.sortBy(a), by.sortBy(b), way)) : rows;
        made = new Map();
        body.replaceChildren(
            ...ordered.flatMap((row) => {
                const cells = columns.map((column, index) => {
                    const content = column.show(row);
                    return index === 0 ? h("th", { scope: "row" }, content) : h("td", { class: column.numeric ? "number" : null }, content);
                });
                const line = h("tr", picked ? { class: "pickable", click: () => picked(row) } : {}, ...cells);
                made.set(row, line);
                const text = below?.(row);
                if (!text) return [line];
                line.classList.add("pair");
                return [line, h("tr", { class: "said" }, h("td", { colspan: columns.length }, text))];
            }),
        );
    }
    fillHead();
    fillBody();
    return {
        element,
        setRows(next) {
            rows = next;
            fillBody();
        },
        setColumns(next) {
            const kept = sorted && next.find((column) => column.head === sorted?.head);
            columns = next;
            sorted = kept;
            fillHead();
            fillBody();
        },
        rowOf: (item) => made.get(item),
    };
}
