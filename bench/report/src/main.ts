// The page of `sconce bench`: what is the same for every scene at the top, then the parts of the chosen scene.
import { analysisSection } from "./analysis_section";
import { h, section, segments } from "./dom";
import { openFoldsOnPaper, reveal } from "./fold";
import { counted } from "./format";
import { gpuSection } from "./gpu_section";
import { imagesSection } from "./images_section";
import { machineSection } from "./machine_section";
import { methodStyles } from "./methods";
import { openingSection } from "./opening_section";
import { planSection } from "./plan_section";
import { plotsSection } from "./plots_section";
import { pointsSection } from "./points_section";
import { loadResults, methodsOf, points, type Results, type Scene } from "./results";
import { Store } from "./store";
import { onSystemTheme, readAddress, setTheme, writeAddress, type Theme } from "./theme";
import { hideTooltip } from "./tooltip";

function answersSection(answers: string[]): HTMLElement {
    return section("answers", "Over all scenes", h("ul", { class: "answers" }, ...answers.map((answer) => h("li", {}, answer))));
}

function build(page: HTMLElement, results: Results): void {
    const scenes = results.scenes ?? [];
    const styles = methodStyles([...new Set(scenes.flatMap(methodsOf))]);
    let store = new Store();
    const body = h("div", { id: "scene" });
    const nav = h("nav", { "aria-label": "Parts of this page" });

    const answers = results.answers ?? [];

    const showScene = (scene: Scene): void => {
        hideTooltip();
        store = new Store();
        const parts: [string, HTMLElement][] = [
            ["In short", openingSection(scene)],
            ...(answers.length > 0 ? [["All scenes", answersSection(answers)] as [string, HTMLElement]] : []),
            ["Costs", plotsSection(scene, styles, store)],
            ["Comparison", analysisSection(scene, styles, store)],
            ["Images", imagesSection(scene, store)],
            ["Probes", planSection(scene)],
            ["Points", pointsSection(scene, styles, store)],
            ...(results.gpu ? [["Graphics card", gpuSection(results.gpu, results, scene)] as [string, HTMLElement]] : []),
            ["Machine", machineSection(results, scene)],
        ];
        const unit = h(
            "p",
            { class: "note" },
            [
                scene.source,
                scene.triangles ? `${scene.triangles.toLocaleString("en-GB")} triangles` : "",
                scene.width ? `${scene.width} × ${scene.height}` : "",
                counted(points(scene).length, "point"),
            ]
                .filter(Boolean)
                .join(" · "),
        );
        body.replaceChildren(
            h("div", { class: "scene-head" }, h("h2", { class: "clip", title: scene.name }, scene.name), unit),
            ...parts.map(([, part]) => part),
        );
        const links = parts.map(([name, part]) =>
            h("a", { href: `#${part.id}`, click: (event: MouseEvent) => (event.preventDefault(), reveal(part)) }, name),
        );
        nav.replaceChildren(...links);
    };

    const address = readAddress();
    const theme = (["auto", "light", "dark"].includes(address.get("theme") ?? "") ? address.get("theme") : "auto") as Theme;
    setTheme(theme);
    const themes = segments(
        "Theme",
        [
            { value: "auto", label: "auto" },
            { value: "light", label: "light" },
            { value: "dark", label: "dark" },
        ],
        theme,
        (value) => {
            setTheme(value as Theme);
            writeAddress("theme", value);
            store.tell("theme");
        },
    );
    onSystemTheme(() => store.tell("theme"));

    const first = scenes.find((scene) => scene.name === address.get("scene")) ?? scenes[0];
    const choice = segments(
        "Scene",
        scenes.map((scene, index) => ({ value: String(index), label: scene.name })),
        String(first ? scenes.indexOf(first) : 0),
        (value) => {
            const scene = scenes[Number(value)];
            if (!scene) return;
            writeAddress("scene", scene.name);
            showScene(scene);
        },
    );
    const header = h(
        "header",
        {},
        h("div", { class: "title" }, h("h1", {}, "Sconce: what accuracy costs in time"), nav, themes.element),
        scenes.length > 1 ? choice.element : null,
    );
    new ResizeObserver(() => document.documentElement.style.setProperty("--header", `${header.offsetHeight}px`)).observe(header);
    page.replaceChildren(
        header,
        h(
            "main",
            {},
            first ? body : h("p", { class: "note" }, "This run has no scenes."),
        ),
    );
    if (first) showScene(first);
    const followAddress = (): void => {
        const part = [...body.children].find((one) => `#${one.id}` === location.hash);
        if (part instanceof HTMLElement) reveal(part);
    };
    addEventListener("hashchange", followAddress);
    followAddress();
    openFoldsOnPaper();
}

function fail(page: HTMLElement, problem: unknown): void {
    page.replaceChildren(
        h(
            "main",
            {},
            h("h1", {}, "This report can't be shown"),
            h("p", { role: "alert", class: "wrong" }, problem instanceof Error ? problem.message : String(problem)),
        ),
    );
}

const page = document.getElementById("page");
if (page) {
    try {
        build(page, loadResults());
    } catch (problem) {
        fail(page, problem);
        console.error(problem);
    }
}
