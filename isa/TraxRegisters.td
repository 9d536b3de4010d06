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
