//===- TraxTargetStreamer.cpp - The directive .stack; limits of symbols --===//
#include "TraxTargetStreamer.h"
#include "TraxAsmGuard.h"
#include "trax/abi.h"
#include "llvm/MC/MCELFObjectWriter.h"
#include "llvm/MC/MCELFStreamer.h"
#include "llvm/MC/TargetRegistry.h"
#include "llvm/Support/FormattedStream.h"
#include "llvm/Support/MathExtras.h"

using namespace llvm;

bool TraxTargetStreamer::setStack(unsigned Place) {
  if (Place != 0 && Stack == 0)
    emitStack(Stack = Place);
  return Place == 0 || Stack == Place;
}

uint64_t TraxTargetStreamer::stepsOf(const MCExpr &Value) const {
  switch (Value.getKind()) {
  case MCExpr::Binary: {
    const auto &Binary = cast<MCBinaryExpr>(Value);
    return SaturatingAdd(stepsOf(*Binary.getLHS()), stepsOf(*Binary.getRHS()));
  }
  case MCExpr::Unary:
    return stepsOf(*cast<MCUnaryExpr>(Value).getSubExpr());
  case MCExpr::SymbolRef:
    return SaturatingAdd(Steps.lookup(&cast<MCSymbolRefExpr>(Value).getSymbol()), uint64_t(1));
  default:
    return 1;
  }
}

/// Limits symbols whose values refer to other symbols. LLVM follows the whole chain for each value, and
/// again from each symbol of the chain.
void TraxTargetStreamer::emitAssignment(MCSymbol *Symbol, const MCExpr *Value) {
  constexpr uint64_t MostSteps = 200'000'000;
  const uint64_t Needed = stepsOf(*Value);
  Steps[Symbol] = Needed;
  AllSteps = SaturatingMultiplyAdd(Needed, Needed, AllSteps);
  if (AllSteps > MostSteps)
    trax::stopAssembly(nullptr, SMLoc(), "a chain of symbols that refer to one another is too long to evaluate");
}

namespace {

class TraxAsmTargetStreamer final : public TraxTargetStreamer {
  formatted_raw_ostream &OS;

  void emitStack(unsigned Place) override {
    OS << "\t.stack\t" << (Place == TRAX_EF_STACK_GLOBAL ? "global" : "local") << '\n';
  }

public:
  TraxAsmTargetStreamer(MCStreamer &S, formatted_raw_ostream &OS) : TraxTargetStreamer(S), OS(OS) {}
};

class TraxELFTargetStreamer final : public TraxTargetStreamer {
  void emitStack(unsigned Place) override {
    ELFObjectWriter &Writer = static_cast<MCELFStreamer &>(getStreamer()).getWriter();
    Writer.setELFHeaderEFlags(Writer.getELFHeaderEFlags() | Place);
  }

public:
  using TraxTargetStreamer::TraxTargetStreamer;
};

} // namespace

void llvm::registerTraxTargetStreamers(Target &T) {
  TargetRegistry::RegisterNullTargetStreamer(
      T, [](MCStreamer &S) -> MCTargetStreamer * { return new TraxTargetStreamer(S); });
  TargetRegistry::RegisterAsmTargetStreamer(
      T, [](MCStreamer &S, formatted_raw_ostream &OS, MCInstPrinter *) -> MCTargetStreamer * {
        return new TraxAsmTargetStreamer(S, OS);
      });
  TargetRegistry::RegisterObjectTargetStreamer(
      T, [](MCStreamer &S, const MCSubtargetInfo &) -> MCTargetStreamer * { return new TraxELFTargetStreamer(S); });
}
