//===- TraxAsmParser.cpp - Assembly to MCInst ----------------------------===//
#include "LLVMTrax.h"
#include "MCTargetDesc/TraxBaseInfo.h"
#include "MCTargetDesc/TraxMCExpr.h"
#include "MCTargetDesc/TraxMCTargetDesc.h"
#include "MCTargetDesc/TraxTargetStreamer.h"
#include "TargetInfo/TraxTargetInfo.h"
#include "TraxAsmGuard.h"
#include "trax/abi.h"
#include "llvm/ADT/StringSwitch.h"
#include "llvm/MC/MCContext.h"
#include "llvm/MC/MCExpr.h"
#include "llvm/MC/MCInst.h"
#include "llvm/MC/MCInstBuilder.h"
#include "llvm/MC/MCInstrInfo.h"
#include "llvm/MC/MCParser/MCAsmLexer.h"
#include "llvm/MC/MCParser/MCAsmParser.h"
#include "llvm/MC/MCParser/MCParsedAsmOperand.h"
#include "llvm/MC/MCParser/MCTargetAsmParser.h"
#include "llvm/MC/MCRegisterInfo.h"
#include "llvm/MC/MCStreamer.h"
#include "llvm/MC/MCSubtargetInfo.h"
#include "llvm/MC/TargetRegistry.h"
#include "llvm/Support/Casting.h"
#include "llvm/Support/MathExtras.h"

using namespace llvm;

namespace {

/// A token, a register, or an expression.
class TraxOperand : public MCParsedAsmOperand {
  enum KindTy { Token, Reg, Imm } Kind;
  StringRef Tok;
  MCRegister RegNum;
  const MCExpr *Expr = nullptr;
  SMLoc Start, End;

  TraxOperand(KindTy Kind, SMLoc Start, SMLoc End) : Kind(Kind), Start(Start), End(End) {}

public:
  static std::unique_ptr<TraxOperand> createToken(StringRef Tok, SMLoc Loc) {
    std::unique_ptr<TraxOperand> Op(new TraxOperand(Token, Loc, Loc));
    Op->Tok = Tok;
    return Op;
  }
  static std::unique_ptr<TraxOperand> createReg(MCRegister Reg, SMLoc Start, SMLoc End) {
    std::unique_ptr<TraxOperand> Op(new TraxOperand(KindTy::Reg, Start, End));
    Op->RegNum = Reg;
    return Op;
  }
  static std::unique_ptr<TraxOperand> createImm(const MCExpr *Expr, SMLoc Start, SMLoc End) {
    std::unique_ptr<TraxOperand> Op(new TraxOperand(Imm, Start, End));
    Op->Expr = Expr;
    return Op;
  }

  bool isToken() const override { return Kind == Token; }
  bool isReg() const override { return Kind == Reg; }
  bool isImm() const override { return Kind == Imm; }
  bool isMem() const override { return false; }
  SMLoc getStartLoc() const override { return Start; }
  SMLoc getEndLoc() const override { return End; }
  StringRef getToken() const { return Tok; }
  MCRegister getReg() const override { return RegNum; }
  const MCExpr *getImm() const { return Expr; }

  /// The operand's value if the assembler knows it, taken as 32 bits: 0xFFFFFE00 is -512.
  std::optional<int64_t> getConstant() const {
    int64_t Value;
    if (Kind != Imm || isa<TraxMCExpr>(Expr) || !Expr->evaluateAsAbsolute(Value) ||
        !(llvm::isInt<32>(Value) || llvm::isUInt<32>(Value)))
      return std::nullopt;
    return SignExtend64<32>(Value);
  }
  bool hasSpecifier(TraxMCExpr::Specifier Spec) const {
    const auto *Part = Kind == Imm ? dyn_cast<TraxMCExpr>(Expr) : nullptr;
    return Part && Part->getSpecifier() == Spec;
  }

  // One predicate for each operand kind of isa/TraxFormats.td and TraxPseudos.td.
  bool isSImm16() const {
    if (std::optional<int64_t> Value = getConstant())
      return isInt<16>(*Value);
    return hasSpecifier(TraxMCExpr::S_LO) || hasSpecifier(TraxMCExpr::S_ABS);
  }
  bool isUImm16() const {
    if (std::optional<int64_t> Value = getConstant())
      return isUInt<16>(*Value);
    return hasSpecifier(TraxMCExpr::S_HI);
  }
  bool isUImm5() const {
    std::optional<int64_t> Value = getConstant();
    return Value && isUInt<5>(*Value);
  }
  bool isSRNum() const {
    std::optional<int64_t> Value = getConstant();
    return Value && !TraxII::getSpecialRegisterName(unsigned(*Value)).empty();
  }
  bool isTrapCode() const {
    std::optional<int64_t> Value = getConstant();
    return Value && !TraxII::getTrapName(unsigned(*Value)).empty();
  }
  bool isFenceKind() const {
    std::optional<int64_t> Value = getConstant();
    return Value && !TraxII::getFenceName(unsigned(*Value)).empty();
  }
  bool isImm32() const { return getConstant().has_value(); }
  bool isSymbol() const {
    int64_t Value; // a number of any size is no symbol
    return Kind == Imm && !isa<TraxMCExpr>(Expr) && !Expr->evaluateAsAbsolute(Value);
  }
  bool isBrTarget() const { return isTarget<18>(); }
  bool isJalTarget() const { return isTarget<23>(); }

  void addRegOperands(MCInst &Inst, unsigned) const { Inst.addOperand(MCOperand::createReg(RegNum)); }
  void addImmOperands(MCInst &Inst, unsigned) const {
    if (std::optional<int64_t> Value = getConstant())
      Inst.addOperand(MCOperand::createImm(*Value));
    else
      Inst.addOperand(MCOperand::createExpr(Expr));
  }

  void print(raw_ostream &OS) const override {
    switch (Kind) {
    case Token:
      OS << '\'' << Tok << '\'';
      break;
    case Reg:
      OS << "register " << RegNum.id();
      break;
    case Imm:
      OS << *Expr;
      break;
    }
  }

private:
  template <unsigned Bits> bool isTarget() const {
    if (std::optional<int64_t> Value = getConstant())
      return isShiftedInt<Bits - 2, 2>(*Value);
    return isSymbol();
  }
};

class TraxAsmParser : public MCTargetAsmParser {
  MCAsmParser &Parser;
  trax::AsmLimits Limits;

#define GET_ASSEMBLER_HEADER
#include "TraxGenAsmMatcher.inc"

  bool parseRegister(MCRegister &Reg, SMLoc &Start, SMLoc &End) override;
  ParseStatus tryParseRegister(MCRegister &Reg, SMLoc &Start, SMLoc &End) override;
  bool ParseInstruction(ParseInstructionInfo &Info, StringRef Name, SMLoc NameLoc, OperandVector &Operands) override;
  bool MatchAndEmitInstruction(SMLoc IDLoc, unsigned &Opcode, OperandVector &Operands, MCStreamer &Out,
                               uint64_t &ErrorInfo, bool MatchingInlineAsm) override;
  ParseStatus parseDirective(AsmToken Directive) override;

  bool parseOperand(OperandVector &Operands, StringRef Mnemonic);
  bool parseMemoryBase(OperandVector &Operands);
  bool parseExpression(const MCExpr *&Expr, SMLoc &End);
  ParseStatus parseNamed(OperandVector &Operands, std::optional<unsigned> (*Find)(StringRef));
  ParseStatus parseSpecialRegister(OperandVector &Operands) {
    return parseNamed(Operands, TraxII::findSpecialRegister);
  }
  ParseStatus parseTrapCode(OperandVector &Operands) { return parseNamed(Operands, TraxII::findTrap); }
  ParseStatus parseFenceKind(OperandVector &Operands) { return parseNamed(Operands, TraxII::findFence); }

  void emit(MCInst Inst, SMLoc Loc, MCStreamer &Out);
  void emitLoadImmediate(const MCInst &Inst, SMLoc Loc, MCStreamer &Out);
  void emitLoadAddress(const MCInst &Inst, SMLoc Loc, MCStreamer &Out);

public:
  enum TraxMatchResultTy {
    Match_Dummy = FIRST_TARGET_MATCH_RESULT_TY,
#define GET_OPERAND_DIAGNOSTIC_TYPES
#include "TraxGenAsmMatcher.inc"
#undef GET_OPERAND_DIAGNOSTIC_TYPES
  };

  TraxAsmParser(const MCSubtargetInfo &STI, MCAsmParser &Parser, const MCInstrInfo &MII, const MCTargetOptions &Options)
      : MCTargetAsmParser(Options, STI, MII), Parser(Parser) {
    Parser.addAliasForDirective(".half", ".2byte");
    Parser.addAliasForDirective(".word", ".4byte");
    Parser.addAliasForDirective(".dword", ".8byte");
    setAvailableFeatures(ComputeAvailableFeatures(STI.getFeatureBits()));
    trax::enterParser(&Parser);
  }
  ~TraxAsmParser() override { trax::enterParser(nullptr); }
};

} // namespace

#define GET_REGISTER_MATCHER
#define GET_MATCHER_IMPLEMENTATION
#define GET_MNEMONIC_SPELL_CHECKER
#include "TraxGenAsmMatcher.inc"

static MCRegister matchRegister(StringRef Name) {
  const std::string Lower = Name.lower();
#define OTHER_NAME(NAME, OTHER, NUMBER) .Case(OTHER, NAME)
  return MatchRegisterName(StringSwitch<StringRef>(Lower) TRAX_REGISTERS(OTHER_NAME).Default(Lower));
#undef OTHER_NAME
}

ParseStatus TraxAsmParser::tryParseRegister(MCRegister &Reg, SMLoc &Start, SMLoc &End) {
  const AsmToken &Tok = getTok();
  Start = Tok.getLoc();
  End = Tok.getEndLoc();
  if (Tok.isNot(AsmToken::Identifier))
    return ParseStatus::NoMatch;
  Reg = matchRegister(Tok.getIdentifier());
  if (!Reg)
    return ParseStatus::NoMatch;
  Lex();
  return ParseStatus::Success;
}

bool TraxAsmParser::parseRegister(MCRegister &Reg, SMLoc &Start, SMLoc &End) {
  if (!tryParseRegister(Reg, Start, End).isSuccess())
    return Error(Start, "expected a register");
  return false;
}

/// An expression, or one under %hi(), %lo() or %abs().
bool TraxAsmParser::parseExpression(const MCExpr *&Expr, SMLoc &End) {
  if (getTok().isNot(AsmToken::Percent))
    return Parser.parseExpression(Expr, End);
  Lex();
  std::optional<TraxMCExpr::Specifier> Spec;
  if (getTok().is(AsmToken::Identifier))
    Spec = TraxMCExpr::parseSpecifier(getTok().getIdentifier());
  if (!Spec)
    return Error(getTok().getLoc(), "expected hi, lo or abs after '%'");
  Lex();
  if (parseToken(AsmToken::LParen, "expected '('") || Parser.parseParenExpression(Expr, End))
    return true;
  Expr = TraxMCExpr::create(Expr, *Spec, getContext());
  int64_t Value;
  if (cast<TraxMCExpr>(Expr)->getSubExpr()->evaluateAsAbsolute(Value))
    Expr = MCConstantExpr::create(cast<TraxMCExpr>(Expr)->apply(Value), getContext());
  return false;
}

/// A name from a fixed list where the operand is a number: "rdsr r4, thread", "trap r4, exit".
ParseStatus TraxAsmParser::parseNamed(OperandVector &Operands, std::optional<unsigned> (*Find)(StringRef)) {
  if (getTok().isNot(AsmToken::Identifier))
    return ParseStatus::NoMatch;
  std::optional<unsigned> Number = Find(getTok().getIdentifier());
  if (!Number)
    return ParseStatus::NoMatch;
  SMLoc Start = getTok().getLoc(), End = getTok().getEndLoc();
  Lex();
  Operands.push_back(TraxOperand::createImm(MCConstantExpr::create(*Number, getContext()), Start, End));
  return ParseStatus::Success;
}

/// "(reg)", the base of a memory operand.
bool TraxAsmParser::parseMemoryBase(OperandVector &Operands) {
  Operands.push_back(TraxOperand::createToken("(", getTok().getLoc()));
  Lex();
  MCRegister Reg;
  SMLoc Start, End;
  if (parseRegister(Reg, Start, End))
    return true;
  Operands.push_back(TraxOperand::createReg(Reg, Start, End));
  SMLoc Close = getTok().getLoc();
  if (parseToken(AsmToken::RParen, "expected ')'"))
    return true;
  Operands.push_back(TraxOperand::createToken(")", Close));
  return false;
}

bool TraxAsmParser::parseOperand(OperandVector &Operands, StringRef Mnemonic) {
  ParseStatus Custom = MatchOperandParserImpl(Operands, Mnemonic, /*ParseForAllFeatures=*/true);
  if (!Custom.isNoMatch())
    return Custom.isFailure();

  MCRegister Reg;
  SMLoc Start, End;
  if (tryParseRegister(Reg, Start, End).isSuccess()) {
    Operands.push_back(TraxOperand::createReg(Reg, Start, End));
    return false;
  }
  // "(reg" is a memory operand without an offset; any other parenthesis starts an expression.
  if (getTok().is(AsmToken::LParen) && getLexer().peekTok().is(AsmToken::Identifier) &&
      matchRegister(getLexer().peekTok().getIdentifier())) {
    Operands.push_back(TraxOperand::createImm(MCConstantExpr::create(0, getContext()), Start, Start));
    return parseMemoryBase(Operands);
  }
  const MCExpr *Expr;
  Start = getTok().getLoc();
  if (parseExpression(Expr, End))
    return true;
  Operands.push_back(TraxOperand::createImm(Expr, Start, End));
  return getTok().is(AsmToken::LParen) ? parseMemoryBase(Operands) : false;
}

bool TraxAsmParser::ParseInstruction(ParseInstructionInfo &, StringRef Name, SMLoc NameLoc, OperandVector &Operands) {
  Limits.check(Parser, NameLoc);
  Operands.push_back(TraxOperand::createToken(Name, NameLoc));
  if (getTok().is(AsmToken::EndOfStatement))
    return false;
  do {
    if (parseOperand(Operands, Name))
      return true;
  } while (parseOptionalToken(AsmToken::Comma));
  return parseToken(AsmToken::EndOfStatement, "expected ',' or the end of the line");
}

/// .stack local, .stack global: where the file's code expects the stack. LLVM has all other directives; the limits
/// only look at them.
ParseStatus TraxAsmParser::parseDirective(AsmToken Directive) {
  Limits.check(Parser, Directive.getLoc());
  Limits.checkDirective(Parser, Directive.getIdentifier(), Directive.getLoc());
  if (Parser.hasPendingError())
    return ParseStatus::Failure;
  if (Directive.getIdentifier() != ".stack")
    return ParseStatus::NoMatch;
  const SMLoc Loc = getTok().getLoc();
  const StringRef Name = getTok().is(AsmToken::Identifier) ? getTok().getIdentifier() : "";
  const unsigned Place =
      StringSwitch<unsigned>(Name).Case("local", TRAX_EF_STACK_LOCAL).Case("global", TRAX_EF_STACK_GLOBAL).Default(0);
  if (Place == 0)
    return Error(Loc, "expected local or global");
  Lex();
  if (Parser.parseEOL())
    return ParseStatus::Failure;
  if (!static_cast<TraxTargetStreamer &>(*getStreamer().getTargetStreamer()).setStack(Place))
    return Error(Loc,
                 "the stack is already in " + Twine(Place == TRAX_EF_STACK_LOCAL ? "global" : "local") + " memory");
  return ParseStatus::Success;
}

void TraxAsmParser::emit(MCInst Inst, SMLoc Loc, MCStreamer &Out) {
  Inst.setLoc(Loc);
  Out.emitInstruction(Inst, getSTI());
}

/// li rd, imm32: the shortest of addi, lui, and lui with addi.
void TraxAsmParser::emitLoadImmediate(const MCInst &Inst, SMLoc Loc, MCStreamer &Out) {
  MCRegister Reg = Inst.getOperand(0).getReg();
  int64_t Value = Inst.getOperand(1).getImm();
  MCRegister Base = Trax::R0;
  if (!isInt<16>(Value)) {
    emit(MCInstBuilder(Trax::LUI).addReg(Reg).addImm(((Value + 0x8000) >> 16) & 0xFFFF), Loc, Out);
    Base = Reg;
    if ((Value & 0xFFFF) == 0)
      return;
  }
  emit(MCInstBuilder(Trax::ADDI).addReg(Reg).addReg(Base).addImm(SignExtend64<16>(Value)), Loc, Out);
}

/// la rd, symbol
void TraxAsmParser::emitLoadAddress(const MCInst &Inst, SMLoc Loc, MCStreamer &Out) {
  MCRegister Reg = Inst.getOperand(0).getReg();
  const MCExpr *Symbol = Inst.getOperand(1).getExpr();
  const MCExpr *Hi = TraxMCExpr::create(Symbol, TraxMCExpr::S_HI, getContext());
  const MCExpr *Lo = TraxMCExpr::create(Symbol, TraxMCExpr::S_LO, getContext());
  emit(MCInstBuilder(Trax::LUI).addReg(Reg).addExpr(Hi), Loc, Out);
  emit(MCInstBuilder(Trax::ADDI).addReg(Reg).addReg(Reg).addExpr(Lo), Loc, Out);
}

bool TraxAsmParser::MatchAndEmitInstruction(SMLoc IDLoc, unsigned &, OperandVector &Operands, MCStreamer &Out,
                                            uint64_t &ErrorInfo, bool MatchingInlineAsm) {
  MCInst Inst;
  unsigned Result = MatchInstructionImpl(Operands, Inst, ErrorInfo, MatchingInlineAsm);
  auto OperandLoc = [&] {
    if (ErrorInfo == ~0ULL || ErrorInfo >= Operands.size())
      return IDLoc;
    SMLoc Loc = Operands[ErrorInfo]->getStartLoc();
    return Loc == SMLoc() ? IDLoc : Loc;
  };
  switch (Result) {
  case Match_Success:
    switch (Inst.getOpcode()) {
    case Trax::PseudoLI:
      emitLoadImmediate(Inst, IDLoc, Out);
      break;
    case Trax::PseudoLA:
      emitLoadAddress(Inst, IDLoc, Out);
      break;
    default:
      emit(Inst, IDLoc, Out);
    }
    return false;
  case Match_MnemonicFail: {
    FeatureBitset Features = ComputeAvailableFeatures(getSTI().getFeatureBits());
    StringRef Mnemonic = static_cast<TraxOperand &>(*Operands[0]).getToken();
    return Error(IDLoc, "unknown instruction '" + Mnemonic + "'" + TraxMnemonicSpellCheck(Mnemonic, Features, 0));
  }
  case Match_InvalidOperand:
    if (ErrorInfo != ~0ULL && ErrorInfo >= Operands.size())
      return Error(IDLoc, "too few operands for instruction");
    return Error(OperandLoc(), "invalid operand for instruction");
  default:
    break;
  }
  if (ErrorInfo != ~0ULL && ErrorInfo >= Operands.size())
    return Error(IDLoc, "too few operands for instruction");
  if (const char *Message = getMatchKindDiag(TraxMatchResultTy(Result)))
    return Error(OperandLoc(), Message);
  return Error(IDLoc, "invalid instruction");
}

void LLVMInitializeTraxAsmParser() {
  RegisterMCAsmParser<TraxAsmParser> X(getTheTraxTarget());
}
