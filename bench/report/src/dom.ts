// Small helpers for making elements.

type Child = Node | string | number | null | undefined | false;
type Attributes = Record<string, string | number | boolean | null | undefined | ((event: never) => void)>;

function fill(element: Element, attributes: Attributes, children: Child[]): void {
    for (const [name, value] of Object.entries(attributes)) {
        if (typeof value === "function") element.addEventListener(name, value as EventListener);
        else if (value === true) element.setAttribute(name, "");
        else if (value !== false && value !== null && value !== undefined) element.setAttribute(name, String(value));
    }
    for (const child of children)
        if (child !== null && child !== undefined && child !== false) element.append(typeof child === "number" ? String(child) : child);
}

/** An HTML element. An attribute that is a function listens to the event of its name. */
export function h<K extends keyof HTMLElementTagNameMap>(
    tag: K,
    attributes: Attributes = {},
    ...children: Child[]
): HTMLElementTagNameMap[K] {
    const element = document.createElement(tag);
    fill(element, attributes, children);
    return element;
}

/** An SVG element. */
export function svg<K extends keyof SVGElementTagNameMap>(
    tag: K,
    attributes: Attributes = {},
    ...children: Child[]
): SVGElementTagNameMap[K] {
    const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
    fill(element, attributes, children);
    return element;
}

/** A function that does the work at the next frame, once, however often it is called before. */
export function perFrame(work: () => void): () => void {
    let asked = false;
    return () => {
        if (asked) return;
        asked = true;
        requestAnimationFrame(() => {
            asked = false;
            work();
        });
    };
}

let counter = 0;
/** An id that no other element has. */
export function freshId(prefix: string): string {
    return `${prefix}-${++counter}`;
}

/** A section with its heading and a line that says what it shows. */
export function section(id: string, title: string, ...children: Child[]): HTMLElement {
    return h("section", { id, "aria-labelledby": `${id}-title` }, h("h2", { id: `${id}-title` }, title), ...children);
}

export interface Choice {
    value: string;
    label: string;
    title?: string;
    key?: string; // that chooses it, shown before the label
    disabled?: boolean;
}

export interface Segments {
    element: HTMLElement;
    set(value: string): void;
}

/** One of several, side by side: native radio buttons, so arrows and tabs work as everywhere. */
export function segments(legend: string, choices: Choice[], chosen: string, changed: (value: string) => void): Segments {
    const name = freshId("choice");
    const inputs = new Map<string, HTMLInputElement>();
    const element = h("fieldset", { class: "segments" }, h("legend", {}, legend));
    for (const choice of choices) {
        const input = h("input", {
            type: "radio",
            name,
            value: choice.value,
            disabled: choice.disabled === true,
            change: () => changed(choice.value),
        });
        input.checked = choice.value === chosen;
        inputs.set(choice.value, input);
        const key = choice.key ? h("kbd", {}, choice.key) : null;
        element.append(
            h("label", { title: choice.title ?? choice.label }, input, h("span", {}, key, h("span", { class: "clip" }, choice.label))),
        );
    }
    return {
        element,
        set(value) {
            for (const [of, input] of inputs) input.checked = of === value;
        },
    };
}

export interface Toggle {
    element: HTMLElement;
    set(on: boolean): void;
}

/** Something that is on or off, looking like one of `segments`. */
export function toggle(label: string, key: string, title: string, changed: (on: boolean) => void): Toggle {
    const input = h("input", { type: "checkbox", "aria-label": title, change: () => changed(input.checked) });
    const text = h("span", {}, h("kbd", {}, key), h("span", { class: "clip" }, label));
    return { element: h("span", { class: "segments" }, h("label", { title }, input, text)), set: (on) => (input.checked = on) };
}

export function select(label: string, choices: Choice[], chosen: string, changed: (value: string) => void): HTMLElement {
    const control = h("select", { "aria-label": label, change: () => changed(control.value) });
    for (const choice of choices) control.append(h("option", { value: choice.value, title: choice.title }, choice.label));
    control.value = chosen;
    return h("label", { class: "field" }, h("span", {}, label), control);
}
