// What the parts of a scene's page share: the point under the pointer, the one that was picked, what is hidden.
import type { Point } from "./results";

export type Change = "hover" | "pick" | "methods" | "knob" | "theme" | "show";

export class Store {
    hovered: Point | null = null;
    picked: Point | null = null;
    shown: Point | null = null; // whose images were asked for
    hidden = new Set<string>(); // methods
    knob = ""; // whose points stand out; empty: all alike
    private listeners = new Map<Change, (() => void)[]>();

    on(changes: Change[], listener: () => void): void {
        for (const change of changes) this.listeners.set(change, [...(this.listeners.get(change) ?? []), listener]);
    }
    tell(change: Change): void {
        for (const listener of this.listeners.get(change) ?? []) listener();
    }

    hover(point: Point | null): void {
        if (this.hovered === point) return;
        this.hovered = point;
        this.tell("hover");
    }
    pick(point: Point | null): void {
        this.picked = point;
        this.tell("pick");
    }
    show(point: Point): void {
        this.shown = point;
        this.tell("show");
    }
    toggle(method: string): void {
        if (!this.hidden.delete(method)) this.hidden.add(method);
        this.tell("methods");
    }
    highlight(knob: string): void {
        this.knob = knob;
        this.tell("knob");
    }
    visible(point: Point): boolean {
        return !this.hidden.has(point.method);
    }
    /** Whether it belongs to the knob that was chosen; a default point belongs to every knob. */
    stands(point: Point): boolean {
        return !this.knob || point.knob === this.knob || point.knob === "default";
    }
}
