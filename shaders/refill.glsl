// Lanes that take the next ray when theirs has ended. Before any pass that does.
#extension GL_KHR_shader_subgroup_ballot : require
const uint kWaitingLanes = 8u; // 4 take as long, 16 longer (bench/results/tried.json, gpu__refill)

/// Whether those that wait, of the lanes that go together, are to take their next rays now: to end a ray and to begin one is work that all of them
/// stand by at, so that it is done for several at once.
bool isTimeToTake(bool waits)
{
    uint waiting = subgroupBallotBitCount(subgroupBallot(waits)), together = subgroupBallotBitCount(subgroupBallot(true));
    return waiting >= min(kWaitingLanes, together);
}
