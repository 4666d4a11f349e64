// Where, with what and by which commands it was measured.
import { h, section } from "./dom";
import { number, plain, seconds } from "./format";
import type { Results, Scene } from "./results";

function list(title: string, rows: [string, string][]): HTMLElement {
    if (rows.length === 0) return h("div", {}, h("h3", {}, title), h("p", { class: "note" }, "not recorded"));
    const entries = h("dl", {});
    for (const [name, value] of rows) entries.append(h("dt", {}, name), h("dd", {}, value));
    return h("div", {}, h("h3", {}, title), entries);
}

const kUnits: [RegExp, string][] = [
    [/_mb$/, ", MB"],
    [/_ms$/, ", ms"],
    [/_s$/, ", s"],
];
const readable = (key: string): string => kUnits.reduce((text, [end, unit]) => text.replace(end, unit), key).replaceAll("_", " ");
const rowsOf = (object: Record<string, unknown> | undefined): [string, string][] =>
    Object.entries(object ?? {}).map(([key, value]) => [readable(key), plain(value)]);

function command(text: string): HTMLElement {
    const state = h("span", { role: "status", class: "note" });
    const code = h("code", { tabindex: 0 }, text);
    const copy = (): void => {
        const select = (): void => {
            getSelection()?.selectAllChildren(code);
            state.textContent = "selected: press Ctrl+C";
        };
        if (!navigator.clipboard) return select();
        navigator.clipboard.writeText(text).then(() => (state.textContent = "copied"), select);
    };
    return h("li", {}, code, h("button", { type: "button", click: copy, "aria-label": `Copy ${text}` }, "Copy"), state);
}

export function machineSection(results: Results, scene: Scene): HTMLElement {
    const reference = scene.reference ?? {};
    const vector = (value: number[] | undefined): string => (value ? value.map((part) => number(part, 4)).join(", ") : "–");
    const noise = Object.entries(reference.estimated_relmse ?? {})
        .map(([layer, value]) => `${layer} ${number(value)}`)
        .join(", ");
    return section(
        "machine",
        "Machine, scene and commands",
        h(
            "div",
            { class: "machine" },
            list("Machine", [
                ...rowsOf(results.machine),
                ["started", plain(results.started)],
                ["whole run", seconds(results.seconds)],
                ["Sconce", plain(results.version)],
            ]),
            list("Vulkan device", rowsOf(results.device)),
            list("Scene", [
                ["file", plain(scene.source)],
                ["triangles", scene.triangles ? scene.triangles.toLocaleString("en-GB") : "–"],
                ["image", scene.width && scene.height ? `${scene.width} × ${scene.height}` : "–"],
                ["camera at", vector(scene.camera?.eye)],
                ["looking at", vector(scene.camera?.target)],
                ["field of view", scene.camera?.fov_degrees ? `${number(scene.camera.fov_degrees)}°` : "–"],
            ]),
            list("Reference", [
                ["paths a pixel", plain(reference.spp)],
                ["time", seconds(reference.seconds)],
                ["own noise (relMSE)", noise || "–"],
            ]),
        ),
        h("h3", {}, "Commands"),
        (results.commands ?? []).length > 0
            ? h("ol", { class: "commands" }, ...(results.commands ?? []).map(command))
            : h("p", { class: "note" }, "No commands were recorded."),
    );
}
