//===- TraxSchedule.td - The scheduler's model of the machine ------------===//
//
// One instruction a cycle, in order; an instruction waits for its operands (docs/timing.md). Units and latencies are those
// of isa/TraxUnits.td.

def TraxModel : SchedMachineModel {
  let IssueWidth = 1;
  let MicroOpBufferSize = 0;
  let LoadLatency = 3;
  let MispredictPenalty = 1;
  let PostRAScheduler = true;
  let CompleteModel = false; // pseudo-instructions have no unit
}

let SchedModel = TraxModel in {

// A load that hits takes the unit's one cycle, but banks conflict and lines miss: a little distance to the first use pays.
foreach unit = TraxUnits in {
  def unit.UnitName#Resource : ProcResource<1> {
    let BufferSize = 0;
  }
  def : WriteRes<unit, [!cast<ProcResource>(unit.UnitName#"Resource")]> {
    let Latency = !if(!eq(unit.UnitName, "MEMORY"), 3, unit.DefaultLatency);
  }
}

} // SchedModel
