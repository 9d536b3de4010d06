//===- TraxPatterns.td - How the compiler chooses instructions -----------===//

//--- nodes ------------------------------------------------------------------

def SDT_TraxCall : SDTypeProfile<0, -1, [SDTCisVT<0, i32>]>;
def SDT_TraxUnary : SDTypeProfile<1, 1, [SDTCisVT<0, i32>, SDTCisVT<1, i32>]>;
def SDT_TraxAddLo : SDTypeProfile<1, 2, [SDTCisVT<0, i32>, SDTCisVT<1, i32>, SDTCisVT<2, i32>]>;
def SDT_TraxTrap : SDTypeProfile<0, 2, [SDTCisVT<0, i32>, SDTCisVT<1, i32>]>;

def trax_call : SDNode<"TraxISD::CALL", SDT_TraxCall, [SDNPHasChain, SDNPOptInGlue, SDNPOutGlue, SDNPVariadic]>;
def trax_tail : SDNode<"TraxISD::TAIL", SDT_TraxCall, [SDNPHasChain, SDNPOptInGlue, SDNPOutGlue, SDNPVariadic]>;
def trax_ret : SDNode<"TraxISD::RET", SDTNone, [SDNPHasChain, SDNPOptInGlue, SDNPVariadic]>;
// An address is hi + lo of a symbol, or, for thread-local symbols, abs.
def trax_hi : SDNode<"TraxISD::HI", SDT_TraxUnary>;
def trax_add_lo : SDNode<"TraxISD::ADD_LO", SDT_TraxAddLo>;
def trax_abs : SDNode<"TraxISD::ABS_ADDR", SDT_TraxUnary>;
def trax_rsqrt : SDNode<"TraxISD::RSQRT", SDTFPUnaryOp>;
def trax_opaque : SDNode<"TraxISD::OPAQUE", SDTIntUnaryOp>; // a copy, which no node sees through
def trax_rdsr_const : SDNode<"TraxISD::RDSR_CONST", SDT_TraxUnary>;
def trax_rdsr : SDNode<"TraxISD::RDSR", SDT_TraxUnary, [SDNPHasChain, SDNPSideEffect]>;
def trax_trap : SDNode<"TraxISD::TRAP", SDT_TraxTrap, [SDNPHasChain, SDNPSideEffect]>;
def trax_halt : SDNode<"TraxISD::HALT", SDTNone, [SDNPHasChain, SDNPSideEffect]>;
def trax_copy_loop : SDNode<"TraxISD::COPY_LOOP",
                            SDTypeProfile<0, 4, [SDTCisVT<0, i32>, SDTCisVT<1, i32>, SDTCisVT<2, i32>, SDTCisVT<3, i32>]>,
                            [SDNPHasChain, SDNPMayLoad, SDNPMayStore]>;
def trax_setjmp : SDNode<"TraxISD::SETJMP", SDT_TraxUnary, [SDNPHasChain, SDNPSideEffect]>;
def trax_longjmp : SDNode<"TraxISD::LONGJMP", SDTypeProfile<0, 1, [SDTCisVT<0, i32>]>, [SDNPHasChain, SDNPSideEffect]>;
def trax_wait : SDNode<"TraxISD::WAIT", SDTypeProfile<0, 1, [SDTCisVT<0, i32>]>, [SDNPHasChain, SDNPSideEffect]>;
def trax_fence : SDNode<"TraxISD::FENCE", SDTypeProfile<0, 1, [SDTCisVT<0, i32>]>,
                        [SDNPHasChain, SDNPMayLoad, SDNPMayStore, SDNPSideEffect]>;
def trax_ainc : SDNode<"TraxISD::AINC", SDTLoad, [SDNPHasChain, SDNPMayLoad, SDNPMayStore, SDNPMemOperand]>;
// A load past the cache, with the memory operand of an atomic load.
def trax_lwnt : SDNode<"TraxISD::LWNT", SDTLoad, [SDNPHasChain, SDNPMayLoad, SDNPMemOperand]>;

def callseq_start : SDNode<"ISD::CALLSEQ_START", SDCallSeqStart<[SDTCisVT<0, i32>, SDTCisVT<1, i32>]>,
                           [SDNPHasChain, SDNPOutGlue]>;
def callseq_end : SDNode<"ISD::CALLSEQ_END", SDCallSeqEnd<[SDTCisVT<0, i32>, SDTCisVT<1, i32>]>,
                         [SDNPHasChain, SDNPOptInGlue, SDNPOutGlue]>;

//--- operands ---------------------------------------------------------------

def NegImm : SDNodeXForm<imm, [{ return CurDAG->getTargetConstant(-N->getSExtValue(), SDLoc(N), MVT::i32); }]>;
def ImmPlus1 : SDNodeXForm<imm, [{ return CurDAG->getTargetConstant(N->getSExtValue() + 1, SDLoc(N), MVT::i32); }]>;
// -imm and imm + 1 fit too.
def simm16_neg : ImmLeaf<i32, [{ return isInt<16>(-Imm); }]>;
def simm16_plus1 : ImmLeaf<i32, [{ return isInt<16>(Imm + 1); }]>;
// The same for unsigned comparison, where -1 + 1 would wrap to "never".
def simm16_plus1_not_neg1 : ImmLeaf<i32, [{ return isInt<16>(Imm + 1) && Imm != -1; }]>;
// Sums that two addi reach and lui alone would not.
def simm17 : ImmLeaf<i32, [{ return !isInt<16>(Imm) && (Imm & 0xFFFF) != 0 && Imm >= -65536 && Imm <= 65534; }]>;
def HalfImm : SDNodeXForm<imm, [{
  return CurDAG->getTargetConstant(N->getSExtValue() / 2, SDLoc(N), MVT::i32);
}]>;
def OtherHalfImm : SDNodeXForm<imm, [{
  int64_t Value = N->getSExtValue();
  return CurDAG->getTargetConstant(Value - Value / 2, SDLoc(N), MVT::i32);
}]>;
// Masks of low bits that andi cannot hold.
def low_mask : ImmLeaf<i32, [{ return isMask_32(uint32_t(Imm)) && !isInt<16>(Imm); }]>;
def LeadingZeros : SDNodeXForm<imm, [{
  return CurDAG->getTargetConstant(llvm::countl_zero(uint32_t(N->getZExtValue())), SDLoc(N), MVT::i32);
}]>;

// The number of a bit that andi can mask.
def andi_bit : ImmLeaf<i32, [{ return Imm >= 0 && Imm < 15; }]>;
def BitMask : SDNodeXForm<imm, [{
  return CurDAG->getTargetConstant(1 << N->getZExtValue(), SDLoc(N), MVT::i32);
}]>;
// A bit that is masked in place and then shifted to bit 0.
def moved_bit : PatFrag<(ops node:$masked), (srl node:$masked, (i32 imm)), [{
  SDValue Masked = N->getOperand(0);
  return Masked.getOpcode() == ISD::AND && isa<ConstantSDNode>(Masked.getOperand(1)) &&
         Masked.getConstantOperandVal(1) == uint64_t(1) << N->getConstantOperandVal(1);
}]>;

def AddrRegImm : ComplexPattern<iPTR, 2, "selectAddrRegImm">;
def AddrFrame : ComplexPattern<iPTR, 2, "selectAddrFrame", [frameindex, or, add]>;
// A shift amount without the mask that the machine applies anyway.
def ShiftAmount : ComplexPattern<i32, 1, "selectShiftAmount", [], [], 0>;

//--- integer ----------------------------------------------------------------

class PatRR<SDPatternOperator node, Instruction inst>
    : Pat<(i32 (node (i32 GPR:$a), (i32 GPR:$b))), (inst GPR:$a, GPR:$b)>;
class PatRI<SDPatternOperator node, Instruction inst>
    : Pat<(i32 (node (i32 GPR:$a), simm16:$imm)), (inst GPR:$a, simm16:$imm)>;
class PatShift<SDPatternOperator node, Instruction inst>
    : Pat<(i32 (node (i32 GPR:$a), (i32 (ShiftAmount (i32 GPR:$b))))), (inst GPR:$a, GPR:$b)>;
class PatShiftImm<SDPatternOperator node, Instruction inst>
    : Pat<(i32 (node (i32 GPR:$a), uimm5:$imm)), (inst GPR:$a, uimm5:$imm)>;

def : PatRR<add, ADD>;
def : PatRR<sub, SUB>;
def : PatRR<and, AND>;
def : PatRR<or, OR>;
def : PatRR<xor, XOR>;
def : PatRR<smin, MIN>;
def : PatRR<smax, MAX>;
def : PatRR<umin, MINU>;
def : PatRR<umax, MAXU>;
def : PatRR<mul, MUL>;
def : PatRR<mulhs, MULH>;
def : PatRR<mulhu, MULHU>;
def : PatRI<add, ADDI>;
def : PatRI<and, ANDI>;
def : PatRI<or, ORI>;
def : PatRI<xor, XORI>;
def : PatShift<shl, SLL>;
def : PatShift<srl, SRL>;
def : PatShift<sra, SRA>;
def : PatShiftImm<shl, SLLI>;
def : PatShiftImm<srl, SRLI>;
def : PatShiftImm<sra, SRAI>;

def : Pat<(i32 (add (i32 GPR:$a), simm17:$imm)), (ADDI (i32 (ADDI GPR:$a, (HalfImm imm:$imm))), (OtherHalfImm imm:$imm))>;
def : Pat<(i32 (and (i32 GPR:$a), low_mask:$m)), (SRLI (i32 (SLLI GPR:$a, (LeadingZeros imm:$m))), (LeadingZeros imm:$m))>;
def : Pat<(i32 (sext_inreg (i32 GPR:$a), i8)), (SRAI (i32 (SLLI GPR:$a, 24)), 24)>;
def : Pat<(i32 (sext_inreg (i32 GPR:$a), i16)), (SRAI (i32 (SLLI GPR:$a, 16)), 16)>;

let AddedComplexity = 1 in
def : Pat<(AddrFrame (i32 GPR:$base), simm16:$imm), (ADDI GPR:$base, simm16:$imm)>;

//--- comparison -------------------------------------------------------------

def : PatRR<setlt, SLT>;
def : PatRR<setult, SLTU>;
def : PatRI<setlt, SLTI>;
def : PatRI<setult, SLTIU>;
def : Pat<(i32 (setgt (i32 GPR:$a), (i32 GPR:$b))), (SLT GPR:$b, GPR:$a)>;
def : Pat<(i32 (setugt (i32 GPR:$a), (i32 GPR:$b))), (SLTU GPR:$b, GPR:$a)>;

class PatNot<dag compare, dag inverse> : Pat<compare, (XORI inverse, 1)>;
def : PatNot<(i32 (setge (i32 GPR:$a), (i32 GPR:$b))), (i32 (SLT GPR:$a, GPR:$b))>;
def : PatNot<(i32 (setuge (i32 GPR:$a), (i32 GPR:$b))), (i32 (SLTU GPR:$a, GPR:$b))>;
def : PatNot<(i32 (setle (i32 GPR:$a), (i32 GPR:$b))), (i32 (SLT GPR:$b, GPR:$a))>;
def : PatNot<(i32 (setule (i32 GPR:$a), (i32 GPR:$b))), (i32 (SLTU GPR:$b, GPR:$a))>;
def : PatNot<(i32 (setge (i32 GPR:$a), simm16:$imm)), (i32 (SLTI GPR:$a, simm16:$imm))>;
def : PatNot<(i32 (setuge (i32 GPR:$a), simm16:$imm)), (i32 (SLTIU GPR:$a, simm16:$imm))>;
def : PatNot<(i32 (setgt (i32 GPR:$a), simm16_plus1:$imm)), (i32 (SLTI GPR:$a, (ImmPlus1 imm:$imm)))>;
def : PatNot<(i32 (setugt (i32 GPR:$a), simm16_plus1_not_neg1:$imm)), (i32 (SLTIU GPR:$a, (ImmPlus1 imm:$imm)))>;
def : Pat<(i32 (setle (i32 GPR:$a), simm16_plus1:$imm)), (SLTI GPR:$a, (ImmPlus1 imm:$imm))>;
def : Pat<(i32 (setule (i32 GPR:$a), simm16_plus1_not_neg1:$imm)), (SLTIU GPR:$a, (ImmPlus1 imm:$imm))>;

def : Pat<(i32 (seteq (i32 GPR:$a), 0)), (SLTIU GPR:$a, 1)>;
def : Pat<(i32 (setne (i32 GPR:$a), 0)), (SLTU (i32 R0), GPR:$a)>;
def : Pat<(i32 (seteq (i32 GPR:$a), simm16_neg:$imm)), (SLTIU (i32 (ADDI GPR:$a, (NegImm imm:$imm))), 1)>;
def : Pat<(i32 (setne (i32 GPR:$a), simm16_neg:$imm)), (SLTU (i32 R0), (i32 (ADDI GPR:$a, (NegImm imm:$imm))))>;
def : Pat<(i32 (seteq (i32 GPR:$a), (i32 GPR:$b))), (SLTIU (i32 (XOR GPR:$a, GPR:$b)), 1)>;
def : Pat<(i32 (setne (i32 GPR:$a), (i32 GPR:$b))), (SLTU (i32 R0), (i32 (XOR GPR:$a, GPR:$b)))>;

//--- selection --------------------------------------------------------------

multiclass SelectPatterns<ValueType vt> {
  def : Pat<(vt (select (i32 GPR:$c), (vt GPR:$t), (vt GPR:$f))), (CMOVNZ GPR:$f, GPR:$t, GPR:$c)>;
  def : Pat<(vt (select (i32 (setne (i32 GPR:$c), 0)), (vt GPR:$t), (vt GPR:$f))), (CMOVNZ GPR:$f, GPR:$t, GPR:$c)>;
  def : Pat<(vt (select (i32 (seteq (i32 GPR:$c), 0)), (vt GPR:$t), (vt GPR:$f))), (CMOVZ GPR:$f, GPR:$t, GPR:$c)>;
  // A conditional move tests for zero, so the bit need not be shifted.
  def : Pat<(vt (select (i32 (and (i32 (srl (i32 GPR:$c), andi_bit:$bit)), 1)), (vt GPR:$t), (vt GPR:$f))),
            (CMOVNZ GPR:$f, GPR:$t, (i32 (ANDI GPR:$c, (BitMask imm:$bit))))>;
  def : Pat<(vt (select (i32 (moved_bit (i32 GPR:$c))), (vt GPR:$t), (vt GPR:$f))), (CMOVNZ GPR:$f, GPR:$t, GPR:$c)>;
  def : Pat<(vt (select (i32 (xor (i32 GPR:$c), 1)), (vt GPR:$t), (vt GPR:$f))), (CMOVNZ GPR:$t, GPR:$f, GPR:$c)>;
  // A condition that would need an inversion or a second instruction picks the other move instead.
  def : Pat<(vt (select (i32 (seteq (i32 GPR:$a), (i32 GPR:$b))), (vt GPR:$t), (vt GPR:$f))),
            (CMOVZ GPR:$f, GPR:$t, (i32 (XOR GPR:$a, GPR:$b)))>;
  def : Pat<(vt (select (i32 (setne (i32 GPR:$a), (i32 GPR:$b))), (vt GPR:$t), (vt GPR:$f))),
            (CMOVNZ GPR:$f, GPR:$t, (i32 (XOR GPR:$a, GPR:$b)))>;
  def : Pat<(vt (select (i32 (seteq (i32 GPR:$a), simm16_neg:$imm)), (vt GPR:$t), (vt GPR:$f))),
            (CMOVZ GPR:$f, GPR:$t, (i32 (ADDI GPR:$a, (NegImm imm:$imm))))>;
  def : Pat<(vt (select (i32 (setne (i32 GPR:$a), simm16_neg:$imm)), (vt GPR:$t), (vt GPR:$f))),
            (CMOVNZ GPR:$f, GPR:$t, (i32 (ADDI GPR:$a, (NegImm imm:$imm))))>;
  def : Pat<(vt (select (i32 (setge (i32 GPR:$a), (i32 GPR:$b))), (vt GPR:$t), (vt GPR:$f))),
            (CMOVZ GPR:$f, GPR:$t, (i32 (SLT GPR:$a, GPR:$b)))>;
  def : Pat<(vt (select (i32 (setuge (i32 GPR:$a), (i32 GPR:$b))), (vt GPR:$t), (vt GPR:$f))),
            (CMOVZ GPR:$f, GPR:$t, (i32 (SLTU GPR:$a, GPR:$b)))>;
  def : Pat<(vt (select (i32 (setle (i32 GPR:$a), (i32 GPR:$b))), (vt GPR:$t), (vt GPR:$f))),
            (CMOVZ GPR:$f, GPR:$t, (i32 (SLT GPR:$b, GPR:$a)))>;
  def : Pat<(vt (select (i32 (setule (i32 GPR:$a), (i32 GPR:$b))), (vt GPR:$t), (vt GPR:$f))),
            (CMOVZ GPR:$f, GPR:$t, (i32 (SLTU GPR:$b, GPR:$a)))>;
  def : Pat<(vt (select (i32 (setgt (i32 GPR:$a), simm16_plus1:$imm)), (vt GPR:$t), (vt GPR:$f))),
            (CMOVZ GPR:$f, GPR:$t, (i32 (SLTI GPR:$a, (ImmPlus1 imm:$imm))))>;
  def : Pat<(vt (select (i32 (setugt (i32 GPR:$a), simm16_plus1_not_neg1:$imm)), (vt GPR:$t), (vt GPR:$f))),
            (CMOVZ GPR:$f, GPR:$t, (i32 (SLTIU GPR:$a, (ImmPlus1 imm:$imm))))>;
}
defm : SelectPatterns<i32>;
defm : SelectPatterns<f32>;

//--- control ----------------------------------------------------------------

class PatBranch<CondCode cond, Instruction inst>
    : Pat<(brcc cond, (i32 GPR:$a), (i32 GPR:$b), bb:$target), (inst GPR:$a, GPR:$b, bb:$target)>;
class PatBranchSwapped<CondCode cond, Instruction inst>
    : Pat<(brcc cond, (i32 GPR:$a), (i32 GPR:$b), bb:$target), (inst GPR:$b, GPR:$a, bb:$target)>;
def : PatBranch<SETEQ, BEQ>;
def : PatBranch<SETNE, BNE>;
def : PatBranch<SETLT, BLT>;
def : PatBranch<SETGE, BGE>;
def : PatBranch<SETULT, BLTU>;
def : PatBranch<SETUGE, BGEU>;
def : PatBranchSwapped<SETGT, BLT>;
def : PatBranchSwapped<SETLE, BGE>;
def : PatBranchSwapped<SETUGT, BLTU>;
def : PatBranchSwapped<SETULE, BGEU>;
// Comparisons with 0 as the optimizer writes them.
let AddedComplexity = 2 in {
def : Pat<(brcc SETGT, (i32 GPR:$a), -1, bb:$target), (BGE GPR:$a, (i32 R0), bb:$target)>;
def : Pat<(brcc SETLT, (i32 GPR:$a), 1, bb:$target), (BGE (i32 R0), GPR:$a, bb:$target)>;
def : Pat<(brcc SETLE, (i32 GPR:$a), -1, bb:$target), (BLT GPR:$a, (i32 R0), bb:$target)>;
def : Pat<(brcc SETGE, (i32 GPR:$a), 1, bb:$target), (BLT (i32 R0), GPR:$a, bb:$target)>;
def : Pat<(brcc SETULT, (i32 GPR:$a), 1, bb:$target), (BEQ GPR:$a, (i32 R0), bb:$target)>;
def : Pat<(brcc SETUGT, (i32 GPR:$a), 0, bb:$target), (BNE GPR:$a, (i32 R0), bb:$target)>;
}

def : Pat<(brind (i32 GPR:$a)), (PseudoBRIND GPR:$a, 0)>;

def : Pat<(trax_call tglobaladdr:$callee), (PseudoCALL tglobaladdr:$callee)>;
def : Pat<(trax_call texternalsym:$callee), (PseudoCALL texternalsym:$callee)>;
def : Pat<(trax_call (i32 GPR:$callee)), (PseudoCALLIndirect GPR:$callee)>;
def : Pat<(trax_tail tglobaladdr:$callee), (PseudoTAIL tglobaladdr:$callee)>;
def : Pat<(trax_tail texternalsym:$callee), (PseudoTAIL texternalsym:$callee)>;
def : Pat<(trax_tail (i32 GPRTC:$callee)), (PseudoTAILIndirect GPRTC:$callee)>;
def : Pat<(trax_ret), (PseudoRET)>;
def : Pat<(callseq_start timm:$size, timm:$unused), (ADJCALLSTACKDOWN timm:$size, timm:$unused)>;
def : Pat<(callseq_end timm:$size, timm:$unused), (ADJCALLSTACKUP timm:$size, timm:$unused)>;

def : Pat<(i32 (trax_opaque (i32 GPR:$a))), (COPY_TO_REGCLASS GPR:$a, GPR)>;
def : Pat<(trax_rdsr_const timm:$n), (PseudoRDSRConst timm:$n)>;
def : Pat<(trax_rdsr timm:$n), (RDSR timm:$n)>;
def : Pat<(trax_trap (i32 GPR:$a), timm:$code), (TRAP GPR:$a, timm:$code)>;
def : Pat<(trax_halt), (PseudoHALT)>;
def : Pat<(trax_copy_loop (i32 GPR:$to), (i32 GPR:$from), timm:$bytes, timm:$unit),
          (PseudoCopyLoop GPR:$to, GPR:$from, timm:$bytes, timm:$unit)>;
def : Pat<(trax_setjmp (i32 GPR:$buffer)), (PseudoSETJMP GPR:$buffer)>;
def : Pat<(trax_longjmp (i32 GPRTC:$buffer)), (PseudoLONGJMP GPRTC:$buffer)>;
def : Pat<(trap), (TRAP (i32 R0), NumberOf<Traps, "abort">.Number)>; // without a message
def : Pat<(debugtrap), (TRAP (i32 R0), NumberOf<Traps, "abort">.Number)>;

//--- floating point ---------------------------------------------------------

class PatFF<SDPatternOperator node, Instruction inst>
    : Pat<(f32 (node (f32 GPR:$a), (f32 GPR:$b))), (inst GPR:$a, GPR:$b)>;

def : PatFF<any_fadd, FADD>;
def : PatFF<any_fsub, FSUB>;
def : PatFF<any_fmul, FMUL>;
def : PatFF<any_fdiv, FDIV>;
def : PatFF<any_fminnum, FMIN>;
def : PatFF<any_fmaxnum, FMAX>;

// A comparison as a value, in a branch and in a selection. Where only the opposite exists, the branch and the move are
// opposite instead.
class PatFSet<CondCode cond, dag result> : Pat<(i32 (setcc (f32 GPR:$a), (f32 GPR:$b), cond)), result>;
class PatFBranch<CondCode cond, dag result>
    : Pat<(brcc cond, (f32 GPR:$a), (f32 GPR:$b), bb:$target), result>;
multiclass FloatCompare<list<CondCode> conditions, dag test> {
  foreach cond = conditions in {
    def : PatFSet<cond, test>;
    def : PatFBranch<cond, (BNE test, (i32 R0), bb:$target)>;
  }
}
multiclass FloatCompareOpposite<list<CondCode> conditions, dag test> {
  foreach cond = conditions in {
    def : PatFSet<cond, (XORI test, 1)>;
    def : PatFBranch<cond, (BEQ test, (i32 R0), bb:$target)>;
    foreach vt = [i32, f32] in
      def : Pat<(vt (select (i32 (setcc (f32 GPR:$a), (f32 GPR:$b), cond)), (vt GPR:$t), (vt GPR:$f))),
                (CMOVZ GPR:$f, GPR:$t, test)>;
  }
}
defm : FloatCompare<[SETOEQ, SETEQ], (i32 (FEQ GPR:$a, GPR:$b))>;
defm : FloatCompare<[SETOLT, SETLT], (i32 (FLT GPR:$a, GPR:$b))>;
defm : FloatCompare<[SETOGT, SETGT], (i32 (FLT GPR:$b, GPR:$a))>;
defm : FloatCompare<[SETOLE, SETLE], (i32 (FLE GPR:$a, GPR:$b))>;
defm : FloatCompare<[SETOGE, SETGE], (i32 (FLE GPR:$b, GPR:$a))>;
defm : FloatCompare<[SETONE], (i32 (OR (i32 (FLT GPR:$a, GPR:$b)), (i32 (FLT GPR:$b, GPR:$a))))>;
defm : FloatCompare<[SETO], (i32 (AND (i32 (FEQ GPR:$a, GPR:$a)), (i32 (FEQ GPR:$b, GPR:$b))))>;
defm : FloatCompareOpposite<[SETUNE, SETNE], (i32 (FEQ GPR:$a, GPR:$b))>;
defm : FloatCompareOpposite<[SETUGE], (i32 (FLT GPR:$a, GPR:$b))>;
defm : FloatCompareOpposite<[SETULE], (i32 (FLT GPR:$b, GPR:$a))>;
defm : FloatCompareOpposite<[SETUGT], (i32 (FLE GPR:$a, GPR:$b))>;
defm : FloatCompareOpposite<[SETULT], (i32 (FLE GPR:$b, GPR:$a))>;
defm : FloatCompareOpposite<[SETUEQ], (i32 (OR (i32 (FLT GPR:$a, GPR:$b)), (i32 (FLT GPR:$b, GPR:$a))))>;
defm : FloatCompareOpposite<[SETUO], (i32 (AND (i32 (FEQ GPR:$a, GPR:$a)), (i32 (FEQ GPR:$b, GPR:$b))))>;

// A float equals itself unless it is a NaN.
let AddedComplexity = 4 in {
def : Pat<(i32 (setcc (f32 GPR:$a), (f32 GPR:$a), SETO)), (FEQ GPR:$a, GPR:$a)>;
def : Pat<(i32 (setcc (f32 GPR:$a), (f32 GPR:$a), SETUO)), (XORI (i32 (FEQ GPR:$a, GPR:$a)), 1)>;
def : Pat<(brcc SETO, (f32 GPR:$a), (f32 GPR:$a), bb:$target), (BNE (i32 (FEQ GPR:$a, GPR:$a)), (i32 R0), bb:$target)>;
def : Pat<(brcc SETUO, (f32 GPR:$a), (f32 GPR:$a), bb:$target), (BEQ (i32 (FEQ GPR:$a, GPR:$a)), (i32 R0), bb:$target)>;
foreach vt = [i32, f32] in
  def : Pat<(vt (select (i32 (setcc (f32 GPR:$a), (f32 GPR:$a), SETUO)), (vt GPR:$t), (vt GPR:$f))),
            (CMOVZ GPR:$f, GPR:$t, (i32 (FEQ GPR:$a, GPR:$a)))>;
}

def : Pat<(i32 (any_fp_to_sint (f32 GPR:$a))), (FCVT_W_S GPR:$a)>;
def : Pat<(i32 (any_fp_to_uint (f32 GPR:$a))), (FCVT_WU_S GPR:$a)>;
def : Pat<(i32 (fp_to_sint_sat (f32 GPR:$a), i32)), (FCVT_W_S GPR:$a)>;
def : Pat<(i32 (fp_to_uint_sat (f32 GPR:$a), i32)), (FCVT_WU_S GPR:$a)>;
def : Pat<(f32 (any_sint_to_fp (i32 GPR:$a))), (FCVT_S_W GPR:$a)>;
def : Pat<(f32 (any_uint_to_fp (i32 GPR:$a))), (FCVT_S_WU GPR:$a)>;
def : Pat<(f32 (trax_rsqrt (f32 GPR:$a))), (FRSQRT GPR:$a)>;
// Sign manipulation without a constant: the mask would cost as many instructions, and a register.
def : Pat<(f32 (fabs (f32 GPR:$a))), (SRLI (i32 (SLLI GPR:$a, 1)), 1)>;
def : Pat<(f32 (fneg (f32 GPR:$a))), (XOR GPR:$a, (i32 (LUI 0x8000)))>;
def : Pat<(f32 (fneg (f32 (fabs (f32 GPR:$a))))), (OR GPR:$a, (i32 (LUI 0x8000)))>;
def : Pat<(i32 (bitconvert (f32 GPR:$a))), (COPY_TO_REGCLASS GPR:$a, GPR)>;
def : Pat<(f32 (bitconvert (i32 GPR:$a))), (COPY_TO_REGCLASS GPR:$a, GPR)>;

//--- addresses --------------------------------------------------------------

multiclass AddressPatterns<SDNode symbol> {
  def : Pat<(trax_hi symbol:$s), (LUI symbol:$s)>;
  def : Pat<(trax_add_lo (i32 GPR:$hi), symbol:$s), (ADDI GPR:$hi, symbol:$s)>;
}
defm : AddressPatterns<tglobaladdr>;
defm : AddressPatterns<texternalsym>;
defm : AddressPatterns<tblockaddress>;
defm : AddressPatterns<tjumptable>;
defm : AddressPatterns<tconstpool>;
def : Pat<(trax_abs tglobaltlsaddr:$s), (ADDI (i32 R0), tglobaltlsaddr:$s)>;

//--- memory -----------------------------------------------------------------

class PatLoad<SDPatternOperator node, Instruction inst, ValueType vt = i32>
    : Pat<(vt (node (AddrRegImm (i32 GPR:$ra), simm16:$imm))), (inst GPR:$ra, simm16:$imm)>;
class PatStore<SDPatternOperator node, Instruction inst, ValueType vt = i32>
    : Pat<(node (vt GPR:$rb), (AddrRegImm (i32 GPR:$ra), simm16:$imm)), (inst GPR:$rb, GPR:$ra, simm16:$imm)>;

def : PatLoad<sextloadi8, LB>;
def : PatLoad<zextloadi8, LBU>;
def : PatLoad<extloadi8, LBU>;
def : PatLoad<sextloadi16, LH>;
def : PatLoad<zextloadi16, LHU>;
def : PatLoad<extloadi16, LHU>;
def : PatLoad<load, LW>;
def : PatLoad<load, LW, f32>;
def : PatStore<truncstorei8, SB>;
def : PatStore<truncstorei16, SH>;
def : PatStore<store, SW>;
def : PatStore<store, SW, f32>;

// Past the cache. TraxLowerAtomics has removed the mark from accesses of local memory.
def nt_load : PatFrag<(ops node:$p), (load node:$p), [{ return cast<LoadSDNode>(N)->isNonTemporal(); }]>;
def nt_store : PatFrag<(ops node:$v, node:$p), (store node:$v, node:$p), [{
  return cast<StoreSDNode>(N)->isNonTemporal();
}]>;
let AddedComplexity = 10 in {
def : PatLoad<nt_load, LWNT>;
def : PatLoad<nt_load, LWNT, f32>;
def : PatStore<nt_store, SWNT>;
def : PatStore<nt_store, SWNT, f32>;
}

//--- atomics ----------------------------------------------------------------

// Caches are written through: a store is atomic as it is. TraxLowerAtomics has put the fences around it.
def : PatStore<atomic_store_8, SB>;
def : PatStore<atomic_store_16, SH>;
def : PatStore<atomic_store_32, SW>;
// Atomic loads become trax_lwnt: caches of different TMs are not coherent.
def : PatLoad<trax_lwnt, LWNT>;
def : PatLoad<trax_ainc, AINC>;
def : Pat<(trax_wait i32:$ra), (PseudoWAIT GPR:$ra)>;
def : Pat<(trax_fence timm:$kind), (FENCE timm:$kind)>;
