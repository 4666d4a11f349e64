// Long parts that are closed until somebody wants them.
import { h } from "./dom";

export function fold(summary: HTMLElement, ...children: HTMLElement[]): HTMLDetailsElement {
    return h("details", { class: "fold" }, summary, ...children);
}

/** Opens what a link leads to, and goes there. */
export function reveal(part: HTMLElement): void {
    for (const closed of part.querySelectorAll<HTMLDetailsElement>("details.fold")) closed.open = true;
    part.scrollIntoView();
}

/** Paper can't be opened: there everything is. */
export function openFoldsOnPaper(): void {
    let opened: HTMLDetailsElement[] = [];
    addEventListener("beforeprint", () => {
        opened = [...document.querySelectorAll<HTMLDetailsElement>("details.fold:not([open])")];
        for (const each of opened) each.open = true;
    });
    addEventListener("afterprint", () => {
        for (const each of opened) each.open = false;
    });
}
