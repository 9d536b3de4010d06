//===- TraxOptions.cpp - the options that clang does not have ------------===//

#include "TraxOptions.h"
#include "PrivateMember.h"
#include "llvm/Option/OptTable.h"
#include "llvm/Option/Option.h"
#include <vector>

using llvm::ArrayRef;
using llvm::StringLiteral;
using llvm::opt::Option;
using llvm::opt::OptTable;

namespace trax {
struct OptionInfos {
  using Type = ArrayRef<OptTable::Info> OptTable::*;
  friend Type addressOf(OptionInfos);
};
template struct Publish<OptionInfos, &OptTable::OptionInfos>;
} // namespace trax

namespace {

constexpr StringLiteral Dash[] = {"-"};

OptTable::Info joined(trax::options::ID ID, StringLiteral Name, const char *Value, const char *Help, unsigned Group,
                      unsigned Flags = 0, const char *Values = nullptr) {
  return {Dash,
          Name,
          Help,
          {},
          Value,
          ID,
          Option::JoinedClass,
          /*Param=*/0,
          Flags,
          clang::driver::options::ClangOption,
          static_cast<unsigned short>(Group),
          /*AliasID=*/0,
          /*AliasArgs=*/nullptr,
          Values};
}

} // namespace

void trax::addOptions() {
  using namespace clang::driver::options;
  auto &Table = const_cast<OptTable &>(clang::driver::getDriverOptTable());
  ArrayRef<OptTable::Info> &Rows = Table.*addressOf(OptionInfos());
  static std::vector<OptTable::Info> Extended(Rows.begin(), Rows.end());
  // The search begins at a name's place in the alphabet and goes to the end of the table, so it finds these rows.
  Extended.push_back(joined(options::OPT_mstack_EQ, "-mstack=", "<place>",
                            "trax: where stacks are: 'local' (512 bytes of local memory, default), 'global' (global "
                            "memory, for programs that need more) or 'either' (objects for both)",
                            OPT_m_Group, TargetSpecific, "local,global,either"));
  Extended.push_back(joined(options::OPT_mstack_size_EQ, "-mstack-size=", "<bytes>",
                            "trax: bytes of each stack with -mstack=global; 'k' and 'M' are understood (default: 64k)",
                            OPT_m_Group));
  Extended.push_back(joined(options::OPT_ffixed_r, "-ffixed-r", "<N>",
                            "trax: generated code does not use register rN (4 to 31)", OPT_f_Group, TargetSpecific));
  Rows = Extended;
}
