// One box beside the pointer for everything that is hovered.
import { h } from "./dom";

let box: HTMLElement | null = null;

/** Shows content beside a place of the window, inside it. */
export function showTooltip(x: number, y: number, ...content: (Node | string)[]): void {
    if (!box) {
        box = h("div", { id: "tooltip", role: "status" });
        document.body.append(box);
    }
    box.replaceChildren(...content);
    box.hidden = false;
    const { width, height } = box.getBoundingClientRect();
    const left = x + 16 + width < innerWidth ? x + 16 : Math.max(4, x - 16 - width);
    const top = Math.min(Math.max(4, y - height / 2), Math.max(4, innerHeight - height - 4));
    box.style.transform = `translate(${Math.round(left)}px, ${Math.round(top)}px)`;
}

export function hideTooltip(): void {
    if (box) box.hidden = true;
}
