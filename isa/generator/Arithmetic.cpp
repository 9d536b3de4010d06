// The manual's tables of arithmetic: every entry is computed with trax/semantics.h.

#include "Isa.h"
#include "trax/semantics.h"
#include "llvm/Support/Format.h"
#include <algorithm>
#include <array>

using namespace llvm;

namespace trax {

namespace {

struct OperandClass {
  const char *Name;
  std::vector<uint32_t> Members; // both ends, and some between
};

using Unary = uint32_t (*)(uint32_t);
using Binary = uint32_t (*)(uint32_t, uint32_t);

enum : uint32_t { Sign = 0x80000000, Infinity = 0x7F800000, NaN = TRAX_CANONICAL_NAN };

} // namespace

static std::vector<OperandClass> operandClasses() {
  const std::vector<uint32_t> Subnormals = {0x00000001, 0x00000002, 0x00400000, 0x007FFFFF};
  const std::vector<uint32_t> Normals = {0x00800000, 0x00800001, 0x34000000, 0x3F000000, 0x3F7FFFFF, 0x3F800000,
                                         0x3F800001, 0x40000000, 0x40490FDB, 0x4B000000, 0x7F000000, 0x7F7FFFFF};
  auto Negative = [](std::vector<uint32_t> Members) {
    for (uint32_t &Member : Members)
      Member |= Sign;
    return Members;
  };
  return {{"-inf", {Sign | Infinity}},
          {"-normal", Negative(Normals)},
          {"-subnormal", Negative(Subnormals)},
          {"-0", {Sign}},
          {"+0", {0}},
          {"+subnormal", Subnormals},
          {"+normal", Normals},
          {"+inf", {Infinity}},
          {"NaN", {NaN, 0x7F800001, 0x7FFFFFFF, 0xFFC00000, 0xFF800001, 0xFFFFFFFF}}};
}

// The property that all results for a class of operands share; Otherwise if there is none.
static std::string describe(const std::vector<std::array<uint32_t, 3>> &Cases, bool IsTruth, StringRef Otherwise) {
  auto All = [&](auto Holds) { return std::all_of(Cases.begin(), Cases.end(), Holds); };
  const std::vector<std::pair<uint32_t, const char *>> Constants =
      IsTruth ? std::vector<std::pair<uint32_t, const char *>>{{0, "0"}, {1, "1"}}
              : std::vector<std::pair<uint32_t, const char *>>{
                    {NaN, "NaN"}, {Infinity, "+inf"}, {Sign | Infinity, "-inf"}, {0, "+0"}, {Sign, "-0"}};
  for (auto &[Value, Name] : Constants)
    if (All([Value = Value](auto &C) { return C[2] == Value; }))
      return Name;
  if (!IsTruth && All([](auto &C) { return C[2] == C[0]; }))
    return "a";
  if (!IsTruth && All([](auto &C) { return C[2] == C[1]; }))
    return "b";
  if (!IsTruth && All([](auto &C) { return C[2] == (C[1] ^ Sign); }))
    return "-b";
  return Otherwise.str();
}

static void emitBinary(raw_ostream &OS, StringRef Mnemonic, Binary Operation, bool IsTruth, StringRef Otherwise) {
  const std::vector<OperandClass> Classes = operandClasses();
  OS << "| `" << Mnemonic << "` a \\ b |";
  for (const OperandClass &B : Classes)
    OS << " " << B.Name << " |";
  OS << "\n|";
  for (size_t I = 0; I <= Classes.size(); ++I)
    OS << " --- |";
  OS << "\n";
  for (const OperandClass &A : Classes) {
    OS << "| " << A.Name << " |";
    for (const OperandClass &B : Classes) {
      std::vector<std::array<uint32_t, 3>> Cases;
      for (uint32_t X : A.Members)
        for (uint32_t Y : B.Members)
          Cases.push_back({X, Y, Operation(X, Y)});
      OS << " " << describe(Cases, IsTruth, Otherwise) << " |";
    }
    OS << "\n";
  }
  OS << "\n";
}

void emitSpecialCases(raw_ostream &OS) {
  emitBinary(OS, "fadd", trax_fadd, false, "r");
  emitBinary(OS, "fsub", trax_fsub, false, "r");
  emitBinary(OS, "fmul", trax_fmul, false, "r");
  emitBinary(OS, "fdiv", trax_fdiv, false, "r");
  emitBinary(OS, "fmin", trax_fmin, false, "c");
  emitBinary(OS, "fmax", trax_fmax, false, "c");
  emitBinary(OS, "feq", trax_feq, true, "c");
  emitBinary(OS, "flt", trax_flt, true, "c");
  emitBinary(OS, "fle", trax_fle, true, "c");

  OS << "| a |";
  const std::vector<OperandClass> Classes = operandClasses();
  for (const OperandClass &A : Classes)
    OS << " " << A.Name << " |";
  OS << "\n|";
  for (size_t I = 0; I <= Classes.size(); ++I)
    OS << " --- |";
  OS << "\n| `frsqrt` |";
  for (const OperandClass &A : Classes) {
    std::vector<std::array<uint32_t, 3>> Cases;
    for (uint32_t X : A.Members)
      Cases.push_back({X, X, trax_frsqrt(X)});
    OS << " " << describe(Cases, false, "r") << " |";
  }
  OS << "\n";
}

static auto word(uint32_t Value) {
  return format_hex(Value, 10, /*Upper=*/true);
}

void emitRounding(raw_ostream &OS) {
  struct Example {
    const char *Mnemonic;
    Binary Operation;
    uint32_t A, B;
    const char *Why;
  };
  const Example Examples[] = {
      {"fadd", trax_fadd, 0x3F800000, 0x33800000, "1 + 2^-24: a tie, to the even neighbour below"},
      {"fadd", trax_fadd, 0x3F800001, 0x33800000, "1 + 2^-23 + 2^-24: a tie, to the even neighbour above"},
      {"fadd", trax_fadd, 0x3F800000, 0x33800001, "just above the tie"},
      {"fadd", trax_fadd, 0x3F800000, 0x00000001, "an operand far below the last place"},
      {"fsub", trax_fsub, 0x3F800000, 0x00000001, "the same, downwards: nearest is 1"},
      {"fsub", trax_fsub, 0x3F800000, 0x33000000, "1 - 2^-25: a tie between 1 and 1 - 2^-24, to the even one"},
      {"fsub", trax_fsub, 0x3F800001, 0x3F800000, "cancellation is exact"},
      {"fsub", trax_fsub, 0x3F800000, 0x3F800000, "an exact zero is +0"},
      {"fsub", trax_fsub, 0x00800001, 0x00800000, "the difference of two normal numbers can be subnormal"},
      {"fadd", trax_fadd, 0x7F7FFFFF, 0x73000000, "the largest number and half its last place: a tie, to infinity"},
      {"fadd", trax_fadd, 0x7F7FFFFF, 0x72FFFFFF, "less than half: the largest number"},
      {"fmul", trax_fmul, 0x3F800001, 0x3F800001, "1 + 2^-22 + 2^-46"},
      {"fmul", trax_fmul, 0x3FC00001, 0x3FC00001, "a significand product of two or more"},
      {"fmul", trax_fmul, 0x7F000000, 0x40000000, "overflow"},
      {"fmul", trax_fmul, 0x00800000, 0x3F000000, "2^-127 is subnormal and exact"},
      {"fmul", trax_fmul, 0x00000001, 0x3F000000, "2^-150: a tie, to zero"},
      {"fmul", trax_fmul, 0x00000003, 0x3F000000, "3 x 2^-150: a tie, to 2 x 2^-149"},
      {"fmul", trax_fmul, 0x00000001, 0x3F000001, "just above the tie: the smallest number"},
      {"fmul", trax_fmul, 0x80000001, 0x3E800000, "-2^-151 underflows to -0"},
      {"fmul", trax_fmul, 0x00FFFFFF, 0x3F000000, "rounds up from the subnormals to the least normal number"},
      {"fdiv", trax_fdiv, 0x3F800000, 0x40400000, "1/3"},
      {"fdiv", trax_fdiv, 0x00800000, 0x4B800000, "2^-150: a tie, to zero"},
      {"fdiv", trax_fdiv, 0x7F7FFFFF, 0x3F7FFFFF, "overflow"},
      {"fdiv", trax_fdiv, 0x007FFFFF, 0x00000001, "both operands subnormal"},
  };
  OS << "| operation | a | b | result | why |\n| --- | --- | --- | --- | --- |\n";
  for (const Example &E : Examples)
    OS << "| `" << E.Mnemonic << "` | " << word(E.A) << " | " << word(E.B) << " | " << word(E.Operation(E.A, E.B))
       << " | " << E.Why << " |\n";
  const std::pair<uint32_t, const char *> Roots[] = {
      {0x3F800000, "1"},
      {0x40000000, "2"},
      {0x3F7FFFFF, "the number below 1"},
      {0x7F7FFFFF, "the largest number"},
      {0x00800000, "2^-126"},
      {0x007FFFFF, "the largest subnormal number"},
      {0x00000001, "2^-149"},
  };
  for (auto &[A, Why] : Roots)
    OS << "| `frsqrt` | " << word(A) << " | | " << word(trax_frsqrt(A)) << " | " << Why << " |\n";
}

void emitConversions(raw_ostream &OS) {
  const std::pair<uint32_t, const char *> Floats[] = {
      {NaN, "NaN"},
      {0xFFC00001, "NaN with sign and payload"},
      {Sign | Infinity, "-inf"},
      {0xCF000001, "the number below -2^31"},
      {0xCF000000, "-2^31"},
      {0xCEFFFFFF, "the number above -2^31"},
      {0xBFC00000, "-1.5"},
      {0xBF800000, "-1"},
      {0xBF7FFFFF, "the number above -1"},
      {0x80000001, "the subnormal number below -0"},
      {0x80000000, "-0"},
      {0x00000000, "+0"},
      {0x00000001, "the subnormal number above +0"},
      {0x3F7FFFFF, "the number below 1"},
      {0x3F800000, "1"},
      {0x3FFFFFFF, "the number below 2"},
      {0x4EFFFFFF, "the number below 2^31"},
      {0x4F000000, "2^31"},
      {0x4F7FFFFF, "the number below 2^32"},
      {0x4F800000, "2^32"},
      {Infinity, "+inf"},
  };
  OS << "| a | value | `fcvt.w.s` | `fcvt.wu.s` |\n| --- | --- | --- | --- |\n";
  for (auto &[A, Name] : Floats)
    OS << "| " << word(A) << " | " << Name << " | " << word(trax_fcvt_w_s(A)) << " | " << word(trax_fcvt_wu_s(A))
       << " |\n";
  const std::pair<uint32_t, const char *> Integers[] = {
      {0x00000000, "0"},
      {0x00000001, "1"},
      {0x00FFFFFF, "2^24 - 1: exact"},
      {0x01000001, "2^24 + 1: a tie, to the even neighbour below"},
      {0x01000003, "2^24 + 3: a tie, to the even neighbour above"},
      {0x7FFFFFBF, "just below a tie"},
      {0x7FFFFFFF, "2^31 - 1"},
      {0x80000000, "2^31, or -2^31"},
      {0x80000001, "the next"},
      {0xFEFFFFFF, "-2^24 - 1 as a signed number: a tie, to even"},
      {0xFFFFFFFF, "2^32 - 1, or -1"},
  };
  OS << "\n| a | value | `fcvt.s.w` | `fcvt.s.wu` |\n| --- | --- | --- | --- |\n";
  for (auto &[A, Name] : Integers)
    OS << "| " << word(A) << " | " << Name << " | " << word(trax_fcvt_s_w(A)) << " | " << word(trax_fcvt_s_wu(A))
       << " |\n";
}

void emitReducedPrecision(raw_ostream &OS) {
  const std::pair<uint32_t, const char *> Results[] = {
      {0x3F812345, "between two results"},
      {0x3F800800, "a tie at 12 bits, to the even one below"},
      {0x3F801800, "a tie at 12 bits, to the even one above"},
      {0x3FC00000, "a tie at 1 bit"},
      {0x40400000, "a tie at 1 bit"},
      {0x3FFFFFFF, "the carry moves to the next binade"},
      {0x7F7FFFFF, "the carry out of the largest binade gives infinity"},
      {0x80800001, "the sign stays"},
      {0x007FFFFF, "subnormal: unchanged"},
      {Sign, "-0"},
      {Sign | Infinity, "-inf"},
      {NaN, "NaN"},
  };
  const unsigned Bits[] = {24, 23, 12, 8, 1};
  OS << "| rounded to 24 bits |";
  for (unsigned B : Bits)
    if (B != 24)
      OS << " to " << B << " |";
  OS << " what |\n| --- |";
  for (size_t I = 0; I < std::size(Bits); ++I)
    OS << " --- |";
  OS << "\n";
  for (auto &[Value, What] : Results) {
    OS << "|";
    for (unsigned B : Bits)
      OS << " " << word(trax_reduce_precision(Value, B)) << " |";
    OS << " " << What << " |\n";
  }
}

} // namespace trax
