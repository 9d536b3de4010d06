//===- unwind_test.cpp - .debug_frame against the true call chain --------===//
//
//   unwind-test PROGRAM [FUNCTION...]
//
// Runs the program and keeps, by watching its calls and returns, what every caller will get back: its sp, its return
// address, its saved registers. Before every instruction the innermost frame is unwound by .debug_frame and compared;
// at some, chosen at random, the whole chain. Functions named may lack frame information; any other function that does
// is an error.
//
//===----------------------------------------------------------------------===//
#include "steps.h"
#include "trax/abi.h"
#include "trax/isa.h"
#include "llvm/ADT/ArrayRef.h"
#include "llvm/DebugInfo/DWARF/DWARFContext.h"
#include "llvm/DebugInfo/DWARF/DWARFDebugFrame.h"
#include "llvm/Object/ELFObjectFile.h"
#include "llvm/Support/Format.h"
#include "llvm/Support/raw_ostream.h"
#include <array>
#include <map>
#include <random>
#include <set>

using namespace llvm;

namespace {

using Registers = std::array<uint32_t, 32>;
constexpr unsigned RA = 1, SP = 2, FP = 3, FirstSaved = 20;

/// The registers that a function must preserve.
struct Frame {
  uint32_t Entry; ///< of the function
  uint32_t ReturnAddress;
  Registers AtCall;
};

/// One function's table and where it begins and ends.
struct Table {
  uint64_t End;
  dwarf::UnwindTable Rows;
};

class Checker {
public:
  explicit Checker(const object::ObjectFile &File);
  void step(const unwind_state &State);
  bool report(ArrayRef<const char *> Excused) const;

private:
  const dwarf::UnwindRow *rowAt(uint32_t Address) const;
  bool unwind(const unwind_state &State, uint32_t Address, Registers &R, uint32_t &ReturnAddress);
  void complain(const unwind_state &State, const Twine &What);
  std::string functionAt(uint32_t Address) const;

  std::unique_ptr<DWARFContext> Context;
  std::map<uint64_t, Table> Tables;
  std::map<uint64_t, std::string> Functions;
  std::vector<Frame> Frames;
  std::set<std::string> Uncovered;
  std::set<uint32_t> Complained;
  std::mt19937 Random{20080927};
  uint64_t Checked = 0, Chains = 0, FramesInChains = 0, Skipped = 0, Wrong = 0;
  size_t Deepest = 0;
};

} // namespace

Checker::Checker(const object::ObjectFile &File) : Context(DWARFContext::create(File)) {
  for (const object::SymbolRef &Symbol : File.symbols())
    if (cantFail(Symbol.getType()) == object::SymbolRef::ST_Function)
      Functions[cantFail(Symbol.getAddress())] = cantFail(Symbol.getName()).str();
  for (const dwarf::FrameEntry &Entry : cantFail(Context->getDebugFrame())->entries())
    if (const auto *FDE = dyn_cast<dwarf::FDE>(&Entry))
      Tables.insert({FDE->getInitialLocation(),
                     {FDE->getInitialLocation() + FDE->getAddressRange(), cantFail(dwarf::UnwindTable::create(FDE))}});
}

std::string Checker::functionAt(uint32_t Address) const {
  auto Next = Functions.upper_bound(Address);
  return Next == Functions.begin() ? "?" : std::prev(Next)->second;
}

const dwarf::UnwindRow *Checker::rowAt(uint32_t Address) const {
  auto Next = Tables.upper_bound(Address);
  if (Next == Tables.begin() || Address >= std::prev(Next)->second.End)
    return nullptr;
  const dwarf::UnwindRow *Found = nullptr;
  for (const dwarf::UnwindRow &Row : std::prev(Next)->second.Rows)
    if (Row.getAddress() <= Address)
      Found = &Row;
  return Found;
}

/// From the registers of a frame whose code is at Address to those of its caller. False without frame information.
bool Checker::unwind(const unwind_state &State, uint32_t Address, Registers &R, uint32_t &ReturnAddress) {
  const dwarf::UnwindRow *Row = rowAt(Address);
  if (!Row)
    return false;
  const dwarf::UnwindLocation &CFAValue = Row->getCFAValue();
  if (CFAValue.getLocation() != dwarf::UnwindLocation::RegPlusOffset) {
    complain(State, "the CFA is not a register and an offset");
    return false;
  }
  static const uint8_t Numbers[] = TRAX_DWARF_REGISTERS;
  uint32_t CFA = R[Numbers[CFAValue.getRegister()]] + uint32_t(CFAValue.getOffset());
  Registers Caller = R;
  for (unsigned DwarfNumber = 1; DwarfNumber != 32; ++DwarfNumber) {
    const unsigned Number = Numbers[DwarfNumber];
    std::optional<dwarf::UnwindLocation> Rule = Row->getRegisterLocations().getRegisterLocation(DwarfNumber);
    if (!Rule || Rule->getLocation() == dwarf::UnwindLocation::Same)
      continue;
    bool IsInFrame = *Rule == dwarf::UnwindLocation::createAtCFAPlusOffset(Rule->getOffset());
    if (!IsInFrame || !unwind_load(&State, CFA + uint32_t(Rule->getOffset()), &Caller[Number])) {
      complain(State, "register r" + Twine(Number) + " cannot be restored");
      return false;
    }
  }
  ReturnAddress = Caller[RA];
  Caller[SP] = CFA;
  R = Caller;
  return true;
}

void Checker::complain(const unwind_state &State, const Twine &What) {
  ++Wrong;
  if (Complained.size() < 20 && Complained.insert(State.pc).second)
    errs() << format_hex(State.pc, 10) << " (" << functionAt(State.pc) << "): " << What << '\n';
}

static bool isSaved(unsigned Register) {
  return Register == FP || Register >= FirstSaved;
}

void Checker::step(const unwind_state &State) {
  trax_inst Previous = trax_decode(State.previous_word);
  Registers R;
  std::copy_n(State.registers, 32, R.begin());
  R[0] = 0;
  bool IsJump = Previous.op == TRAX_OP_JAL || Previous.op == TRAX_OP_JALR;
  // A call of the next instruction is one of a weak function that is not there.
  if (IsJump && Previous.rd == RA && State.pc != State.previous_pc + 4) {
    Frames.push_back({State.pc, R[RA], R});
    Deepest = std::max(Deepest, Frames.size());
  } else if (Previous.op == TRAX_OP_JALR && !Frames.empty() && State.pc == Frames.back().ReturnAddress &&
             R[SP] == Frames.back().AtCall[SP]) {
    Frames.pop_back();
  }
  if (Frames.empty())
    return; // _start

  uint32_t ReturnAddress = 0, Address = State.pc;
  bool WholeChain = Random() % 64 == 0;
  for (size_t Depth = Frames.size(); Depth-- > 0;) {
    const Frame &True = Frames[Depth];
    if (!unwind(State, Address, R, ReturnAddress)) {
      ++Skipped;
      Uncovered.insert(functionAt(Address));
      return;
    }
    if (ReturnAddress != True.ReturnAddress || R[SP] != True.AtCall[SP]) {
      complain(State, "depth " + Twine(Frames.size() - 1 - Depth) + ": return address 0x" +
                          Twine::utohexstr(ReturnAddress) + " and sp 0x" + Twine::utohexstr(R[SP]) +
                          ", but they are 0x" + Twine::utohexstr(True.ReturnAddress) + " and 0x" +
                          Twine::utohexstr(True.AtCall[SP]));
      return;
    }
    for (unsigned Number = 0; Number != 32; ++Number)
      if (isSaved(Number) && R[Number] != True.AtCall[Number]) {
        complain(State, "depth " + Twine(Frames.size() - 1 - Depth) + ": r" + Twine(Number) + " is restored to 0x" +
                            Twine::utohexstr(R[Number]) + ", but was 0x" + Twine::utohexstr(True.AtCall[Number]));
        return;
      }
    ++Checked;
    if (!WholeChain)
      return;
    ++FramesInChains;
    Address = ReturnAddress - 4; // the call
  }
  ++Chains;
}

bool Checker::report(ArrayRef<const char *> Excused) const {
  outs() << Checked << " frames unwound, " << Chains << " whole chains of " << FramesInChains << " frames, depth "
         << Deepest << ", " << Skipped << " without frame information, " << Wrong << " wrong\n";
  bool Good = Wrong == 0 && Chains > 0 && Deepest > 1;
  for (const std::string &Name : Uncovered)
    if (!is_contained(Excused, Name)) {
      errs() << "no frame information: " << Name << '\n';
      Good = false;
    }
  return Good;
}

int main(int Argc, char **Argv) {
  if (Argc < 2) {
    errs() << "usage: unwind-test PROGRAM [FUNCTION...]\n";
    return 1;
  }
  Expected<object::OwningBinary<object::ObjectFile>> Binary = object::ObjectFile::createObjectFile(Argv[1]);
  if (!Binary) {
    errs() << Argv[1] << ": " << toString(Binary.takeError()) << '\n';
    return 1;
  }
  Checker C(*Binary->getBinary());
  if (!unwind_run(
          Argv[1], [](void *Context, const unwind_state *State) { static_cast<Checker *>(Context)->step(*State); }, &C))
    return 1;
  return C.report(ArrayRef<const char *>(Argv + 2, Argc - 2)) ? 0 : 1;
}
