//===- TraxABI.cpp - how aggregates are passed ---------------------------===//
//
// Clang chooses calling conventions by architecture inside its library. An unknown architecture gets DefaultABIInfo,
// whose header is not installed, but whose vtable is exported. Its entry of computeInfo is replaced by a function that
// calls the original and then edits the result through the public CGFunctionInfo (docs/llvm-releases.md says why).
//
// This file is compiled with -fPIC: the address of the vtable must be the library's own, not a copy's.
//
//===----------------------------------------------------------------------===//

#include "TraxABI.h"
#include "clang/AST/ASTContext.h"
#include "clang/AST/Decl.h"
#include "clang/AST/DeclCXX.h"
#include "clang/AST/RecordLayout.h"
#include "clang/CodeGen/CGFunctionInfo.h"
#include "llvm/IR/DerivedTypes.h"
#include "llvm/Support/ErrorHandling.h"
#include "llvm/Support/MathExtras.h"
#include "llvm/Support/Process.h"
#include <sys/mman.h>

using namespace clang;
using clang::CodeGen::ABIArgInfo;
using clang::CodeGen::CGFunctionInfo;
using llvm::StringRef;

// The little that is needed of the private class, by its exported names.
namespace clang::CodeGen {
class ABIInfo {
public:
  ASTContext &getContext() const;
  llvm::LLVMContext &getVMContext() const;
};
} // namespace clang::CodeGen
using clang::CodeGen::ABIInfo;

extern "C" {
extern void *DefaultABIInfoVTable[] __asm__("_ZTVN5clang7CodeGen14DefaultABIInfoE");
void defaultComputeInfo(const ABIInfo *, CGFunctionInfo &) __asm__(
    "_ZNK5clang7CodeGen14DefaultABIInfo11computeInfoERNS0_14CGFunctionInfoE");
}

namespace {

constexpr uint64_t WordBits = 32;
constexpr uint64_t MaxRegisterBits = 4 * WordBits;

/// Finds a type for each word of an aggregate, so that floats and pointers keep their types in registers: the optimizer
/// then sees three floats for a vec3, not integers that are cast. Offsets and sizes are in bits.
class WordTypes {
public:
  WordTypes(const ASTContext &Context, llvm::LLVMContext &VM, QualType Type) : Context(Context), VM(VM) {
    add(Type, 0);
    const uint64_t End = Context.getTypeSize(Type);
    for (uint64_t Word = 0; Word < End && !Leaves.empty();) {
      const Leaf *Alone = onlyLeafAt(Word);
      const bool Typed = Alone && Alone->Type && Alone->Offset == Word &&
                         (Alone->Size == WordBits || onlyLeafAt(Word + WordBits) == Alone);
      Types.push_back(Typed ? Alone->Type : llvm::Type::getInt32Ty(VM));
      Word += Typed ? Alone->Size : WordBits;
    }
  }

  /// One type for each word or double word; none if the aggregate has no members.
  llvm::ArrayRef<llvm::Type *> types() const { return Types; }

private:
  struct Leaf {
    uint64_t Offset, Size;
    llvm::Type *Type; // null unless it fills whole words
  };
  const ASTContext &Context;
  llvm::LLVMContext &VM;
  llvm::SmallVector<Leaf, 16> Leaves;
  llvm::SmallVector<llvm::Type *, 4> Types;

  /// The only member in the word, or null. A union may have the same one several times.
  const Leaf *onlyLeafAt(uint64_t Word) const {
    const Leaf *Alone = nullptr;
    for (const Leaf &L : Leaves) {
      if (L.Offset >= Word + WordBits || L.Offset + L.Size <= Word)
        continue;
      if (Alone && (Alone->Offset != L.Offset || Alone->Type != L.Type))
        return nullptr;
      if (!Alone)
        Alone = &L;
    }
    return Alone;
  }

  void add(QualType Type, uint64_t Offset) {
    const uint64_t Size = Context.getTypeSize(Type);
    if (const auto *Array = Context.getAsConstantArrayType(Type)) {
      const uint64_t ElementSize = Context.getTypeSize(Array->getElementType());
      for (uint64_t At = 0; At < Size; At += ElementSize)
        add(Array->getElementType(), Offset + At);
    } else if (const auto *Complex = Type->getAs<ComplexType>()) {
      add(Complex->getElementType(), Offset);
      add(Complex->getElementType(), Offset + Size / 2);
    } else if (const RecordDecl *Record = Type->getAsRecordDecl()) {
      addMembers(*Record, Offset);
    } else if (Size) {
      Leaves.push_back({Offset, Size, scalarType(Type, Size)});
    }
  }

  void addMembers(const RecordDecl &Record, uint64_t Offset) {
    const ASTRecordLayout &Layout = Context.getASTRecordLayout(&Record);
    if (const auto *Class = dyn_cast<CXXRecordDecl>(&Record))
      for (const CXXBaseSpecifier &Base : Class->bases()) {
        const CXXRecordDecl *BaseClass = Base.getType()->getAsCXXRecordDecl();
        addMembers(*BaseClass, Offset + Context.toBits(Layout.getBaseClassOffset(BaseClass)));
      }
    for (const FieldDecl *Field : Record.fields()) {
      const uint64_t At = Offset + Layout.getFieldOffset(Field->getFieldIndex());
      if (!Field->isBitField())
        add(Field->getType(), At);
      else if (const unsigned Width = Field->getBitWidthValue(Context))
        Leaves.push_back({At, Width, nullptr});
    }
  }

  llvm::Type *scalarType(QualType Type, uint64_t Size) const {
    if (Size != WordBits && Size != 2 * WordBits)
      return nullptr;
    if (Type->isRealFloatingType())
      return Size == WordBits ? llvm::Type::getFloatTy(VM) : llvm::Type::getDoubleTy(VM);
    if (Type->hasPointerRepresentation())
      return llvm::PointerType::get(VM, 0);
    return Type->isIntegralOrEnumerationType() ? llvm::Type::getIntNTy(VM, Size) : nullptr;
  }
};

bool isAggregate(QualType Type) {
  return Type->isRecordType() || Type->isAnyComplexType();
}

bool fitsRegisters(const ASTContext &Context, QualType Type) {
  if (!isAggregate(Type) || Context.getTypeSize(Type) > MaxRegisterBits)
    return false;
  const RecordDecl *Record = Type->getAsRecordDecl();
  return !Record || Record->canPassInRegisters();
}

ABIArgInfo inRegisters(const ABIInfo &ABI, QualType Type) {
  const WordTypes Words(ABI.getContext(), ABI.getVMContext(), Type);
  if (Words.types().empty())
    return ABIArgInfo::getIgnore();
  if (Words.types().size() == 1)
    return ABIArgInfo::getDirect(Words.types().front());
  return ABIArgInfo::getDirect(llvm::StructType::get(ABI.getVMContext(), Words.types()));
}

void computeInfo(const ABIInfo *ABI, CGFunctionInfo &Function) {
  defaultComputeInfo(ABI, Function);
  const ASTContext &Context = ABI->getContext();

  const QualType ReturnType = Function.getReturnType();
  if (Function.getReturnInfo().isIndirect() && fitsRegisters(Context, ReturnType))
    Function.getReturnInfo() = inRegisters(*ABI, ReturnType);

  unsigned Index = 0;
  for (CodeGen::CGFunctionInfoArgInfo &Argument : Function.arguments()) {
    const bool IsNamed = Index++ < Function.getNumRequiredArgs();
    if (!Argument.info.isIndirect())
      continue;
    if (!IsNamed)
      Argument.info.setIndirectByVal(false); // va_arg reads a pointer
    else if (fitsRegisters(Context, Argument.type))
      Argument.info = inRegisters(*ABI, Argument.type);
    else if (Argument.info.getIndirectByVal() && Argument.info.getIndirectAlign().getQuantity() > 4)
      // The stack has words only: the callee moves its copy to where it is aligned.
      Argument.info = ABIArgInfo::getIndirect(CharUnits::fromQuantity(4), /*ByVal=*/true, /*Realign=*/true);
  }
}

} // namespace

void trax::installABI() {
  constexpr int MaxEntries = 8;
  for (void **Entry = DefaultABIInfoVTable; Entry < DefaultABIInfoVTable + MaxEntries; ++Entry) {
    if (*Entry == reinterpret_cast<void *>(computeInfo))
      return; // a second compilation in this process
    if (*Entry != reinterpret_cast<void *>(defaultComputeInfo))
      continue;
    const uintptr_t PageSize = llvm::sys::Process::getPageSizeEstimate();
    void *Page = reinterpret_cast<void *>(reinterpret_cast<uintptr_t>(Entry) / PageSize * PageSize);
    if (mprotect(Page, PageSize, PROT_READ | PROT_WRITE) == 0) {
      *Entry = reinterpret_cast<void *>(computeInfo);
      mprotect(Page, PageSize, PROT_READ);
      return;
    }
    break;
  }
  llvm::report_fatal_error("cannot set the calling convention in this version of clang's library",
                           /*gen_crash_diag=*/false);
}
