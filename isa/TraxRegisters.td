//===- TraxRegisters.td - the 32 registers of a TP -----------------------===//

class TraxReg<bits<16> number, string name, list<string> alt>
    : Register<name, alt>, DwarfRegNum<[number]> {
  let HWEncoding = number;
  let Namespace = "Trax";
}

def R0 : TraxReg<0, "r0", ["zero"]> { let isConstant = true; }
def R1 : TraxReg<1, "r1", ["ra"]>;
def R2 : TraxReg<2, "r2", ["sp"]>;
def R3 : TraxReg<3, "r3", ["fp"]>;
foreach i = 0-7 in def R#!add(i, 4) : TraxReg<!add(i, 4), "r"#!add(i, 4), ["a"#i]>;
foreach i = 0-7 in def R#!add(i, 12) : TraxReg<!add(i, 12), "r"#!add(i, 12), ["t"#i]>;
foreach i = 0-11 in def R#!add(i, 20) : TraxReg<!add(i, 20), "r"#!add(i, 20), ["s"#i]>;

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
