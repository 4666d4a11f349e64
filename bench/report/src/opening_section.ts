// How a scene begins: ours, the strongest opponent and the reference beside each other, then three sentences.
import { h, section, segments } from "./dom";
import { number } from "./format";
import {
    kLayers,
    load,
    paint,
    referenceOf,
    sharedExposure,
    toneTable,
    type Entry,
    type Layer,
    type Loaded,
    type Paint,
} from "./image_layers";
import { methodName } from "./methods";
import { measure, openingSentences, opponentsOf, oursOf, strongest, type Measure } from "./opening";
import { imagesOf, type Point, type Scene } from "./results";

/** A picture's place, with its caption; the picture comes when it is unpacked. */
interface Still {
    element: HTMLElement;
    place: HTMLElement;
    entry: Entry | null; // null: there is no opponent
}

function still(entry: Entry | null, facts: string[]): Still {
    const name = entry?.label ?? "no opponent";
    const place = h("div", { class: "still" });
    const title = h("strong", { class: "clip", title: name }, name);
    const caption = h("figcaption", {}, title, ...facts.map((fact) => ` · ${fact}`));
    return { element: h("figure", {}, place, caption), place, entry };
}

function stillOf(point: Point, flip: Measure): Still {
    const known = (by: Measure, unit: string): string[] => (by.of(point) === null ? [] : [`${unit}${by.show(point)}`]);
    const facts = [...known(flip, "FLIP "), ...known(measure("frame_ms"), "")];
    return still({ label: methodName(point.method), point, images: imagesOf(point) }, facts);
}

/** Ours, the opponent whose picture of the term is best, the reference. */
function stillsOf(scene: Scene, ours: Point, layer: Layer): Still[] {
    const flip = measure(`error.${layer.key}.flip`);
    const their = strongest(opponentsOf(scene), flip);
    const paths = scene.reference?.spp;
    return [
        stillOf(ours, flip),
        their ? stillOf(their, flip) : still(null, []),
        still(referenceOf(scene), paths ? [`${number(paths)} paths a pixel`] : []),
    ];
}

function fill(place: HTMLElement, loaded: Loaded | null, layer: Layer, how: Paint): void {
    const canvas = loaded ? paint(loaded, layer, how) : null;
    canvas?.setAttribute("role", "img");
    canvas?.setAttribute("aria-label", `${layer.label} of ${loaded?.label}`);
    place.replaceChildren(canvas ?? h("p", { class: "note" }, loaded?.problem || `No opponent's ${layer.label} was measured.`));
}

function pictures(scene: Scene, ours: Point, layers: Layer[]): HTMLElement {
    const row = h("div", { class: "stills", style: `--aspect: ${scene.width} / ${scene.height}` });
    let turn = 0;
    const show = async (layer: Layer): Promise<void> => {
        const mine = ++turn;
        const stills = stillsOf(scene, ours, layer);
        row.replaceChildren(...stills.map((one) => one.element));
        const loaded = await Promise.all(stills.map(({ entry }) => (entry ? load(entry, layer, undefined) : null)));
        if (mine !== turn) return; // another term was chosen meanwhile
        const present = loaded.filter((one): one is Loaded => one !== null);
        const how = { tones: toneTable(sharedExposure(loaded[2] ?? null, present)), top: 1 };
        stills.forEach(({ place }, index) => fill(place, loaded[index] ?? null, layer, how));
    };
    const first = layers[0] as Layer;
    const choice = segments(
        "Pictures of",
        layers.map((layer) => ({ value: layer.key, label: layer.label })),
        first.key,
        (key) => void show(layers.find((layer) => layer.key === key) ?? first),
    );
    void show(first);
    return h(
        "div",
        { class: "stack" },
        row,
        h(
            "div",
            { class: "controls" },
            layers.length > 1 ? choice.element : null,
            h("span", { class: "note" }, "One exposure for all. FLIP: how different a picture looks from the reference, from 0 to 1."),
        ),
    );
}

export function openingSection(scene: Scene): HTMLElement {
    const ours = oursOf(scene);
    const layers = kLayers.filter((layer) => layer.colours && imagesOf(ours)[layer.key]);
    const sized = (scene.width ?? 0) > 0 && (scene.height ?? 0) > 0;
    return section(
        "opening",
        "In short",
        ours && sized && layers.length > 0
            ? pictures(scene, ours, layers)
            : h("p", { class: "note" }, "No picture of Sconce's was kept of this scene."),
        h("ul", { class: "answers large" }, ...openingSentences(scene).map((text) => h("li", {}, text))),
    );
}
