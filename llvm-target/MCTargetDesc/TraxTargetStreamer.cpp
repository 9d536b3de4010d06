//===- TraxTargetStreamer.cpp - The directive .stack ---------------------===//
#include "TraxTargetStreamer.h"
#include "trax/abi.h"
#include "llvm/MC/MCELFObjectWriter.h"
#include "llvm/MC/MCELFStreamer.h"
#include "llvm/MC/TargetRegistry.h"
#include "llvm/Support/FormattedStream.h"

using namespace llvm;

bool TraxTargetStreamer::setStack(unsigned Place) {
  if (Place != 0 && Stack == 0)
    emitStack(Stack = Place);
  return Place == 0 || Stack == Place;
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
