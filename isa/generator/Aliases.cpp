// The assembler's shorthands (isa/TraxAliases.td) and their expansions, as text.

#include "Isa.h"
#include "llvm/ADT/StringExtras.h"
#include "llvm/TableGen/Error.h"
#include <algorithm>
#include <map>

using namespace llvm;

namespace trax {

// "add\t$rd, ${ra}" with operands replaced; those that Texts lacks stay under their names.
static std::string render(StringRef AsmString, const std::map<std::string, std::string> &Texts) {
  std::string Result;
  while (!AsmString.empty()) {
    if (!AsmString.consume_front("$")) {
      Result += AsmString.front() == '\t' ? ' ' : AsmString.front();
      AsmString = AsmString.drop_front();
      continue;
    }
    bool Braced = AsmString.consume_front("{");
    StringRef Name = AsmString.take_while([](char C) { return isAlnum(C); });
    AsmString = AsmString.drop_front(Name.size() + Braced);
    auto It = Texts.find(Name.str());
    Result += It == Texts.end() ? Name.str() : It->second;
  }
  return Result;
}

// An operand of the aliased instruction: a register, a number, or an operand of the alias.
static std::string readArgument(const Record *R, const DagInit *Result, unsigned N) {
  if (const StringInit *Name = Result->getArgName(N))
    return Name->getValue().str();
  if (auto *Number = dyn_cast<IntInit>(Result->getArg(N)))
    return itostr(Number->getValue());
  auto *Def = dyn_cast<DefInit>(Result->getArg(N));
  if (!Def || !Def->getDef()->isSubClassOf("TraxReg"))
    PrintFatalError(R->getLoc(), "operand " + Twine(N) + " of the alias is no register, number or operand of its own");
  return Def->getDef()->getValueAsString("AsmName").str();
}

static Alias readAlias(const Record *R) {
  const DagInit *Result = R->getValueAsDag("ResultInst");
  const Record *Target = Result->getOperatorAsDef(R->getLoc());
  std::map<std::string, std::string> Texts;
  unsigned N = 0;
  for (StringRef List : {"OutOperandList", "InOperandList"}) {
    const DagInit *Operands = Target->getValueAsDag(List);
    for (unsigned I = 0; I < Operands->getNumArgs(); ++I, ++N)
      Texts[Operands->getArgNameStr(I).str()] = readArgument(R, Result, N);
  }
  return {render(R->getValueAsString("AsmString"), {}),
          "`" + render(Target->getValueAsString("AsmString"), Texts) + "`", R->getValueAsInt("EmitPriority") > 0};
}

// In the order of the description.
static std::vector<const Record *> definitions(RecordKeeper &Records, StringRef Class) {
  std::vector<const Record *> Result;
  for (const Record *R : Records.getAllDerivedDefinitions(Class))
    Result.push_back(R);
  std::sort(Result.begin(), Result.end(), [](const Record *A, const Record *B) { return A->getID() < B->getID(); });
  return Result;
}

std::vector<Alias> readAliases(RecordKeeper &Records) {
  std::vector<Alias> Aliases;
  for (const Record *R : definitions(Records, "InstAlias"))
    Aliases.push_back(readAlias(R));
  for (const Record *R : definitions(Records, "TraxAsmPseudo"))
    Aliases.push_back({render(R->getValueAsString("AsmString"), {}), R->getValueAsString("Expansion").str(), false});
  return Aliases;
}

} // namespace trax
