// Who wins, by ours / theirs of something that is better when it is lower.

const kEven = 0.03; // a ratio within it of 1 is neither a win nor a loss

export type Outcome = "win" | "loss" | "even";

export function outcomeOf(ratio: number): Outcome {
    if (!(Math.abs(ratio - 1) > kEven)) return "even"; // 0 / 0, too
    return ratio < 1 ? "win" : "loss";
}
