// The points that nothing shown beats in both error and cost.

export interface Placed<T> {
    x: number; // cost
    y: number; // error
    item: T;
}

/** From cheap to dear; of equal points the first. Lower is better on both axes. */
export function paretoFront<T>(placed: Placed<T>[]): Placed<T>[] {
    const front: Placed<T>[] = [];
    let best = Infinity;
    for (const candidate of [...placed].sort((a, b) => a.x - b.x || a.y - b.y)) {
        if (candidate.y >= best) continue;
        best = candidate.y;
        front.push(candidate);
    }
    return front;
}
