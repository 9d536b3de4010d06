//===- TraxRegisters.td - the 32 registers of a TP -----------------------===//

// The number of a register in debug information is the one that its role has on RISC-V: stock GDB knows no machine that is
// nearer (docs/debugging.md).
class TraxReg<int number, string other, int dwarf>
    : Register<"r"#number, [other]>, DwarfRegNum<[dwarf]> {
  int Number = number;
  let HWEncoding = number;
  let Namespace = "Trax";
}

def R0 : TraxReg<0, "zero", 0> { let isConstant = true; }
def R1 : TraxReg<1, "ra", 1>;
def R2 : TraxReg<2, "sp", 2>;
def R3 : TraxReg<3, "fp", 8>;
foreach i = 0-7 in def R#!add(i, 4) : TraxReg<!add(i, 4), "a"#i, !add(i, 10)>;
foreach i = 0-2 in def R#!add(i, 12) : TraxReg<!add(i, 12), "t"#i, !add(i, 5)>;
foreach i = 3-6 in def R#!add(i, 12) : TraxReg<!add(i, 12), "t"#i, !add(i, 25)>;
def R19 : TraxReg<19, "t7", 3>; // RISC-V's gp
def R20 : TraxReg<20, "s0", 9>; // s1: its s0 is fp
foreach i = 1-10 in def R#!add(i, 20) : TraxReg<!add(i, 20), "s"#i, !add(i, 17)>;
def R31 : TraxReg<31, "s11", 4>; // tp

// One class holds integers and floats: the TP has one register file (paper, section 3.1). Temporaries first, then
// arguments from the last one, then saved registers: the order in which the allocator takes them.
def GPR : RegisterClass<"Trax", [i32, f32], 32,
    (add (sequence "R%u", 12, 19), (sequence "R%u", 11, 4), (sequence "R%u", 20, 31), R3, R1, R0, R2)> {
  let DiagnosticString = "operand must be a register";
}

// Registers that follow one another, as the compiler sees the operands of instructions that read several from one field
// on (InstGroups in TraxFormats.td). r0 to r3 have uses of their own and belong to none. No group has both saved registers and
// others: calls would seem to change all of its registers, in code without groups, too.
let Namespace = "Trax" in
foreach i = 0-8 in def group#i : SubRegIndex<32, !mul(32, i)>;
foreach n = [6, 9] in {
def GroupsOf#n : RegisterTuples<!foreach(i, !range(n), !cast<SubRegIndex>("group"#i)),
    !foreach(i, !range(n), (add (sequence "R%u", !add(4, i), !add(!sub(20, n), i)),
                                (sequence "R%u", !add(20, i), !add(!sub(32, n), i))))>;
def Group#n : RegisterClass<"Trax", [untyped], 32, (add !cast<RegisterTuples>("GroupsOf"#n))> {
  let Size = !mul(32, n);
  let GeneratePressureSet = false; // code without groups stays as it is
}
}
