// What a person would say of a scene, and which opponent stands beside ours: made of the points alone, a loss said like a win.
import { figure, withUnit } from "./figures";
import { number, ratio } from "./format";
import { isOpponent, methodName } from "./methods";
import { outcomeOf } from "./outcome";
import { isNumber, nameOf, points, type Point, type Price, type Scene } from "./results";

/** What is compared, better when it is lower. */
export interface Measure {
    label: string;
    of(point: Point): number | null;
    show(point: Point): string;
}

export function measure(key: string): Measure {
    const of = figure(key);
    return { label: of.label, of: of.of, show: (point) => withUnit(of, of.of(point)) };
}

/** " (2.0 % too dark)": its diffuse light on average. */
function brightnessText(point: Point): string {
    const mean = figure("error.diffuse.mean").of(point);
    if (mean === null) return "";
    const percent = 100 * (mean - 1);
    if (Math.abs(percent) < 0.05) return " (as bright as it should be)";
    return ` (${number(Math.abs(percent), 2)} % too ${percent < 0 ? "dark" : "bright"})`;
}

/** Default settings: they have as many probes, as nearly as a grid's shape allows. */
const defaults = (scene: Scene): Point[] => points(scene).filter((point) => point.knob === "default");

export function oursOf(scene: Scene): Point | undefined {
    return defaults(scene).find((point) => point.method === "ours");
}

/** A wrong picture is no opponent, as in the tables. */
export function opponentsOf(scene: Scene): Point[] {
    return defaults(scene).filter((point) => isOpponent(point.method) && !point.wrong);
}

/** The opponent that is hardest to beat; none where it wasn't measured of any. */
export function strongest(opponents: Point[], by: Measure): Point | undefined {
    const measured = opponents.filter((point) => by.of(point) !== null);
    return measured.sort((a, b) => Number(by.of(a)) - Number(by.of(b)))[0];
}

function verdict(ours: number, theirs: number): string {
    const outcome = outcomeOf(ours / theirs);
    if (outcome === "even") return "a draw";
    const factor = outcome === "win" ? theirs / ours : ours / theirs;
    return `Sconce ${outcome === "win" ? "wins" : "loses"}${Number.isFinite(factor) ? ` by a factor of ${number(factor)}` : ""}`;
}

/** "Sconce's frame takes 20 ms, 30 ms with B0+: Sconce wins by a factor of 1.50". @param begin, end  of the words around our figure */
function compared(begin: string, end: string, by: Measure, ours: Point, their: Point | undefined): string {
    const mine = by.of(ours);
    if (mine === null) return `not measured of Sconce: ${by.label}`;
    const own = `${begin}${by.show(ours)}${end}`;
    if (!their) return own;
    const name = methodName(their.method);
    const theirs = by.of(their);
    if (theirs === null) return `${own}, not measured with ${name}`;
    return `${own}, ${by.show(their)} with ${name}: ${verdict(mine, theirs)}`;
}

function sentence(...clauses: string[]): string {
    const text = clauses.filter(Boolean).join("; ");
    return `${text.charAt(0).toUpperCase()}${text.slice(1)}.`;
}

function probesText(ours: Point, their: Point | undefined): string {
    const [mine, theirs] = [ours.probes, their?.probes];
    if (!isNumber(mine)) return "";
    if (!isNumber(theirs)) return `With ${mine} probes, `;
    return mine === theirs ? `With ${mine} probes each, ` : `With ${mine} probes against ${theirs}, `;
}

function raysSentence(ours: Point, opponents: Point[]): string {
    const near = measure("rays.wrong");
    const exact = measure("rays.wrong_02");
    const their = strongest(opponents, near);
    return sentence(
        compared(probesText(ours, their), " of Sconce's glossy rays are wrong within 1 % of the diagonal", near, ours, their),
        exact.of(ours) === null ? "" : compared("", " within 0.2 %", exact, ours, strongest(opponents, exact)),
        their ? "" : "no opponent's rays were judged",
    );
}

function pictureSentence(ours: Point, opponents: Point[]): string {
    const picture = measure("error.beauty.flip");
    const flip = measure("error.diffuse.flip");
    const diffuse = { ...flip, show: (point: Point) => flip.show(point) + brightnessText(point) };
    const their = strongest(opponents, picture);
    return sentence(
        compared("Sconce's picture is off by FLIP ", "", picture, ours, their),
        diffuse.of(ours) === null ? "" : compared("its diffuse light by ", "", diffuse, ours, strongest(opponents, diffuse)),
        their ? "" : "no opponent's picture was judged",
    );
}

/** What half the error would cost, by the knob that takes the least time for it: of wrong rays, else of reflections. */
function priceText(scene: Scene): string {
    const all = scene.analysis?.prices ?? [];
    const [key, what] = all.some((row) => row.error_key === "wrong_rays")
        ? ["wrong_rays", "half as many rays wrong within 1 %"]
        : ["glossy.relmse", "half the error of reflections"];
    const rows = all.filter((row) => row.error_key === key);
    if (rows.length === 0) return "";
    const betters = (row: Price): boolean => isNumber(row.error_ratio) && row.error_ratio < 1;
    const time = (row: Price): number => (betters(row) ? (row.halving_costs_time ?? Infinity) : Infinity);
    const row = rows.reduce((best, next) => (time(next) < time(best) ? next : best));
    if (time(row) === Infinity) return `no knob that was varied would buy ${what}`;
    const to = points(scene).find((point) => point.id === row.to);
    const memory = isNumber(row.halving_costs_memory) ? ` and ${ratio(row.halving_costs_memory)} the memory` : "";
    const of = isNumber(row.time_ratio) ? "frame time" : "reads"; // which the analysis takes where there are no times
    return `${what} would cost ${ratio(time(row))} the ${of}${memory}, at the rate of ${to ? nameOf(to) : row.knob}`;
}

function costSentence(scene: Scene, ours: Point, their: Point | undefined): string {
    return sentence(
        compared("Sconce's frame takes ", "", measure("frame_ms"), ours, their),
        compared("its light field takes ", "", measure("bytes.total"), ours, their),
        priceText(scene),
    );
}

/** Rays, picture, cost: a sentence each, rays and light against whoever has them best, cost against whose picture is best. */
export function openingSentences(scene: Scene): string[] {
    const ours = oursOf(scene);
    if (!ours) return ["Sconce's default setting was not measured in this scene."];
    const opponents = opponentsOf(scene);
    const pictured = strongest(opponents, measure("error.beauty.flip"));
    return [
        ...(ours.wrong ? [`Sconce's picture is wrong here: ${ours.wrong}`] : []),
        raysSentence(ours, opponents),
        pictureSentence(ours, opponents),
        costSentence(scene, ours, pictured ?? strongest(opponents, measure("frame_ms"))),
    ];
}
