// Reading the instruction records: encodings, operands and properties, with the checks that need the whole list.

#include "Isa.h"
#include "llvm/ADT/SmallVector.h"
#include "llvm/ADT/StringRef.h"
#include "llvm/TableGen/Error.h"
#include <algorithm>

using namespace llvm;

namespace trax {

static bool flag(const Record *R, StringRef Name) {
  return R->getValueAsBit(Name);
}

// Mask, match and fields from the bits of Inst: a BitInit is fixed, a VarBitInit belongs to a field.
static void readEncoding(const Record *R, Instruction &I) {
  const BitsInit *Bits = R->getValueAsBitsInit("Inst");
  for (int Bit = 31; Bit >= 0; --Bit) {
    const Init *Value = Bits->getBit(Bit);
    if (auto *Fixed = dyn_cast<BitInit>(Value)) {
      I.Mask |= 1u << Bit;
      I.Match |= uint32_t(Fixed->getValue()) << Bit;
      continue;
    }
    auto *Var = dyn_cast<VarBitInit>(Value);
    if (!Var)
      PrintFatalError(R->getLoc(), "bit " + Twine(Bit) + " of Inst is neither fixed nor part of a field");
    std::string Name = Var->getBitVar()->getAsString();
    unsigned Low = Bit - Var->getBitNum();
    if (I.Fields.empty() || I.Fields.back().Name != Name)
      I.Fields.push_back({Name, Low, 0});
    if (I.Fields.back().Low != Low)
      PrintFatalError(R->getLoc(), "field " + Name + " is not contiguous");
    ++I.Fields.back().Width;
  }
  if ((I.Mask >> 26) != 0x3F)
    PrintFatalError(R->getLoc(), "the major opcode (bits 31..26) is not fixed");
}

// The letter of an operand in the assembler's syntax, and how its immediate is read.
static char readOperandKind(const Record *R, StringRef Type, StringRef Name, Instruction &I) {
  if (Type == "GPR")
    return Name == "rd" ? 'd' : Name == "ra" ? 'a' : Name == "rb" ? 'b' : 'o';
  if (Type == "simm16") {
    I.ImmSigned = true;
    return 'i';
  }
  if (Type == "brtarget" || Type == "jaltarget") {
    I.ImmSigned = true;
    I.ImmScale = 4;
    return 'p';
  }
  if (Type == "uimm16")
    return 'u';
  if (Type == "uimm5")
    return 'i';
  if (Type == "srnum")
    return 's';
  if (Type == "trapcode")
    return 't';
  if (Type == "fencekind")
    return 'f';
  PrintFatalError(R->getLoc(), "operand type " + Type + " is unknown to the generator");
}

static void readOperands(const Record *R, Instruction &I) {
  std::vector<std::pair<std::string, char>> Kinds;
  auto Read = [&](StringRef List, bool IsOutput) {
    const DagInit *Dag = R->getValueAsDag(List);
    for (unsigned N = 0; N < Dag->getNumArgs(); ++N) {
      StringRef Name = Dag->getArgNameStr(N);
      char Kind = readOperandKind(R, cast<DefInit>(Dag->getArg(N))->getDef()->getName(), Name, I);
      Kinds.push_back({Name.str(), Kind});
      I.WritesRD |= IsOutput && Kind == 'd';
      I.ReadsRA |= !IsOutput && Kind == 'a';
      I.ReadsRB |= !IsOutput && Kind == 'b';
    }
  };
  Read("OutOperandList", true);
  Read("InOperandList", false);

  StringRef Text = R->getValueAsString("AsmString");
  auto [Mnemonic, Operands] = Text.split('\t');
  I.Mnemonic = Mnemonic.str();
  for (size_t At = 0; At < Operands.size();) {
    if (Operands[At] != '$') {
      I.AssemblerText += Operands[At];
      if (Operands[At] != ' ')
        I.Syntax += Operands[At];
      ++At;
      continue;
    }
    StringRef Rest = Operands.substr(At + 1);
    bool Braced = Rest.consume_front("{");
    StringRef Name = Rest.take_while([](char C) { return isalnum(C); });
    auto It = std::find_if(Kinds.begin(), Kinds.end(), [&](auto &K) { return K.first == Name; });
    if (It == Kinds.end())
      PrintFatalError(R->getLoc(), "AsmString names no operand: " + Name);
    I.Syntax += It->second;
    I.AssemblerText += Name;
    At += 1 + Name.size() + (Braced ? 2 : 0);
  }
}

// Statements of several lines are written as one.
static std::string onOneLine(StringRef Text) {
  std::string Line;
  SmallVector<StringRef> Words;
  Text.split(Words, '\n');
  for (StringRef Part : Words)
    if (!Part.trim().empty())
      Line += (Line.empty() ? "" : " ") + Part.trim().str();
  return Line;
}

static Instruction readInstruction(const Record *R) {
  Instruction I;
  I.Name = R->getName().str();
  readEncoding(R, I);
  readOperands(R, I);
  I.Format = R->getValueAsDef("Format")->getValueAsString("FormatName").str();
  I.Unit = R->getValueAsDef("Unit")->getValueAsString("UnitName").str();
  I.Semantics = onOneLine(R->getValueAsString("Semantics"));
  I.Manual = R->getValueAsString("Manual").str();
  I.AccessBytes = R->getValueAsInt("AccessBytes");
  I.ImmFirst = R->getValueAsInt("ImmFirst");
  I.ImmLimit = R->getValueAsInt("ImmLimit");
  I.ReadsRD = flag(R, "ReadsRD");
  I.GroupA = R->getValueAsInt("GroupA");
  I.GroupB = R->getValueAsInt("GroupB");
  I.IsAtomic = flag(R, "IsAtomic");
  I.IsNontemporal = flag(R, "IsNontemporal");
  I.IsFlop = flag(R, "IsFlop");
  I.IsCompare = flag(R, "IsCompare");
  I.IsConversion = flag(R, "IsConversion");
  I.IsRoot = flag(R, "IsRoot");
  I.IsBranch = flag(R, "isBranch");
  I.IsRelative = I.IsBranch && !flag(R, "isIndirectBranch");
  I.IsLoad = flag(R, "mayLoad") && I.AccessBytes;
  I.IsStore = flag(R, "mayStore") && I.AccessBytes && !I.IsAtomic;
  if (I.GroupA < 1 || I.GroupA > 16 || I.GroupB < 1 || I.GroupB > 16)
    PrintFatalError(R->getLoc(), "a group has 1 to 16 registers");
  if (I.Manual.empty() || I.Semantics.empty())
    PrintFatalError(R->getLoc(), "an instruction needs semantics and a sentence for the manual");
  return I;
}

// Two encodings overlap if no bit that both fix differs.
static void checkEncodings(const std::vector<Instruction> &Instructions) {
  for (size_t A = 0; A < Instructions.size(); ++A)
    for (size_t B = 0; B < A; ++B) {
      const Instruction &X = Instructions[A], &Y = Instructions[B];
      if (((X.Match ^ Y.Match) & X.Mask & Y.Mask) == 0)
        PrintFatalError("the encodings of " + X.Name + " and " + Y.Name + " overlap");
    }
}

// Instructions of one format have the same fields.
static void checkFormats(const std::vector<Instruction> &Instructions) {
  for (const Instruction &X : Instructions)
    for (const Instruction &Y : Instructions) {
      if (X.Format != Y.Format)
        continue;
      bool Same = X.Fields.size() == Y.Fields.size();
      for (size_t N = 0; Same && N < X.Fields.size(); ++N)
        Same = X.Fields[N].Name == Y.Fields[N].Name && X.Fields[N].Low == Y.Fields[N].Low &&
               X.Fields[N].Width == Y.Fields[N].Width;
      if (!Same)
        PrintFatalError(X.Name + " and " + Y.Name + " have the same format but other fields");
    }
}

static void readFormats(RecordKeeper &Records, Isa &Isa) {
  for (const Instruction &I : Isa.Instructions) {
    auto HasName = [&](const Format &F) { return F.Name == I.Format; };
    if (std::find_if(Isa.Formats.begin(), Isa.Formats.end(), HasName) == Isa.Formats.end())
      Isa.Formats.push_back({I.Format, Records.getDef("Format" + I.Format)->getValueAsString("Description").str()});
  }
}

static void readRegisters(RecordKeeper &Records, Isa &Isa) {
  for (const Record *R : Records.getAllDerivedDefinitions("TraxReg"))
    Isa.Registers.push_back(
        {unsigned(R->getValueAsInt("Number")), unsigned(R->getValueAsListOfInts("DwarfNumbers").front()),
         R->getValueAsString("AsmName").str(), R->getValueAsListOfStrings("AltNames").front().str()});
  std::sort(Isa.Registers.begin(), Isa.Registers.end(),
            [](const Register &A, const Register &B) { return A.Number < B.Number; });
}

Isa readIsa(RecordKeeper &Records) {
  Isa Isa;
  for (const Record *R : Records.getAllDerivedDefinitions("TraxUnit"))
    Isa.Units.push_back({R->getName().str(), R->getValueAsString("UnitName").str(),
                         R->getValueAsString("Description").str(), R->getValueAsInt("DefaultLatency")});
  for (const Record *R : Records.getAllDerivedDefinitions("TraxInst"))
    Isa.Instructions.push_back(readInstruction(R));
  std::sort(Isa.Instructions.begin(), Isa.Instructions.end(),
            [](const Instruction &A, const Instruction &B) { return A.Match < B.Match; });
  checkEncodings(Isa.Instructions);
  checkFormats(Isa.Instructions);
  readFormats(Records, Isa);
  readRegisters(Records, Isa);
  for (const Record *R : Records.getAllDerivedDefinitions("TraxNumbers")) {
    Numbers List{R->getValueAsString("List").str(), R->getValueAsString("Prefix").str(), {}, R->getValueAsInt("First")};
    for (StringRef Name : R->getValueAsListOfStrings("Names"))
      List.Names.push_back(Name.str());
    Isa.Named.push_back(std::move(List));
  }
  Isa.Aliases = readAliases(Records);
  return Isa;
}

} // namespace trax
