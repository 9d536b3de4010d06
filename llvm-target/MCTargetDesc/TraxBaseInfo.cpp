//===- TraxBaseInfo.cpp - What code generation and MC share --------------===//
#include "TraxBaseInfo.h"
#include "trax/abi.h"
#include "llvm/ADT/ArrayRef.h"
#include "llvm/ADT/STLExtras.h"

using namespace llvm;

static constexpr StringLiteral SpecialRegisters[] = {"thread", "tm", "tp", "threads", "cycle", "cycleh"};
static_assert(std::size(SpecialRegisters) == TRAX_SR_COUNT && TRAX_SR_THREADS == 3 && TRAX_SR_CYCLEH == 5);

static constexpr StringLiteral Traps[] = {"exit", "putc", "abort", "rays", "items", "puts", "kinds"};
static_assert(std::size(Traps) == TRAX_TRAP_COUNT && TRAX_TRAP_ABORT == 2 && TRAX_TRAP_KINDS == 6);

static constexpr StringLiteral Fences[] = {"", "r", "w", "rw"}; // nothing is number 0
static_assert(std::size(Fences) == TRAX_FENCE_RW + 1 && TRAX_FENCE_R == 1 && TRAX_FENCE_W == 2);

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
