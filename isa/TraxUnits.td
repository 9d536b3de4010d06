//===- TraxUnits.td - where an instruction executes, and how long --------===//
//
// The timing model arbitrates for units (docs/timing.md). A latency here is the machine's default, which the compiler
// schedules for. The emulator's configuration can change latencies, but not the unit of an instruction.

class TraxUnit<string name, string what, int latency> : SchedWrite {
  string UnitName = name;        // becomes TRAX_UNIT_<name>
  string Description = what;
  int DefaultLatency = latency;  // cycles from issue to the result's use
}

def UnitInt    : TraxUnit<"INT",     "the TP's own integer unit", 1>;
def UnitIntMul : TraxUnit<"INT_MUL", "integer multiplier, shared by 16 TPs", 1>;
def UnitFPAdd  : TraxUnit<"FP_ADD",  "floating-point adder, shared by a cluster of 8 TPs", 1>;
def UnitFPMul  : TraxUnit<"FP_MUL",  "floating-point multiplier, shared by a cluster of 8 TPs", 1>;
def UnitSpecial : TraxUnit<"SPECIAL", "FPDIV/iSQRT unit, shared by the TM", 8>;
def UnitMemory : TraxUnit<"MEMORY",  "local memory, or the TM's data cache and the memory behind it, by address", 1>;
def UnitControl : TraxUnit<"CONTROL", "the TP's own sequencer", 1>;
def UnitRayBox : TraxUnit<"RAY_BOX", "ray unit, shared by TPs; a machine need not have one", 13>;
def UnitRayTriangle : TraxUnit<"RAY_TRIANGLE", "the same", 26>;

defvar TraxUnits = [UnitInt, UnitIntMul, UnitFPAdd, UnitFPMul, UnitSpecial, UnitMemory, UnitControl, UnitRayBox,
                     UnitRayTriangle]; // all of them
