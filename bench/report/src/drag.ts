// Dragging with the mouse, a pen or a finger.

/** Calls `moved` with every step of a drag that begins on the element. */
export function onDrag(element: HTMLElement, moved: (event: PointerEvent, dx: number, dy: number) => void): void {
    element.addEventListener("pointerdown", (down) => {
        if (down.button !== 0) return;
        element.setPointerCapture(down.pointerId);
        let [x, y] = [down.clientX, down.clientY];
        const step = (event: PointerEvent): void => {
            moved(event, event.clientX - x, event.clientY - y);
            [x, y] = [event.clientX, event.clientY];
        };
        const end = (): void => {
            element.removeEventListener("pointermove", step);
            element.removeEventListener("pointerup", end);
            element.removeEventListener("pointercancel", end);
        };
        element.addEventListener("pointermove", step);
        element.addEventListener("pointerup", end);
        element.addEventListener("pointercancel", end);
    });
}
