//===- TraxBaseInfo.cpp - Names for code generation and MC ---------------===//
#include "TraxBaseInfo.h"
#include "trax/abi.h"
#include "llvm/ADT/ArrayRef.h"
#include "llvm/ADT/STLExtras.h"

using namespace llvm;

#define NAME(CONSTANT, TEXT, NUMBER) TEXT,
static constexpr StringLiteral SpecialRegisters[] = {TRAX_SPECIAL_REGISTERS(NAME)};
static constexpr StringLiteral Traps[] = {TRAX_TRAPS(NAME)};
static constexpr StringLiteral Fences[] = {"", TRAX_FENCES(NAME)}; // 0 is no fence
#undef NAME

static StringRef nameOf(ArrayRef<StringLiteral> Names, unsigned Number) {
  return Number < Names.size() ? StringRef(Names[Number]) : StringRef();
}

static std::optional<unsigned> numberOf(ArrayRef<StringLiteral> Names, StringRef Name) {
  const auto *It = find(Names, Name);
  if (It == Names.end())
    return std::nullopt;
  return It - Names.begin();
}

StringRef TraxII::getSpecialRegisterName(unsigned Number) {
  return nameOf(SpecialRegisters, Number);
}
StringRef TraxII::getTrapName(unsigned Code) {
  return nameOf(Traps, Code);
}
StringRef TraxII::getFenceName(unsigned Kind) {
  return nameOf(Fences, Kind);
}
std::optional<unsigned> TraxII::findSpecialRegister(StringRef Name) {
  return numberOf(SpecialRegisters, Name);
}
std::optional<unsigned> TraxII::findTrap(StringRef Name) {
  return numberOf(Traps, Name);
}
std::optional<unsigned> TraxII::findFence(StringRef Name) {
  return numberOf(Fences, Name);
}
