//===- FileCalls.cpp - LLVM's inputs and outputs -------------------------===//
//
// Static constructors of LLVM may call these functions before those of this file have run, and its signal handler calls
// unlink. So nothing here needs construction, and the list that unlink reads changes only at its head.
//
//===----------------------------------------------------------------------===//
#undef _FORTIFY_SOURCE // which defines open itself
#include "FileCalls.h"
#include "trax/message.h"
#include "trax/output.h"
#include "trax/reads.h"

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <mutex>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace {

/// A file that this process has opened for writing.
struct Written {
  // Own: it was created under a new name; Direct: a device; Removed: an earlier file that LLVM has removed, so that the
  // appended bytes replace it.
  enum State { Own, Direct, Collected, Dropped, Removed };
  std::atomic<State> Now;
  int Memory; // of a collected file: its contents
  bool Appended;
  char *Path;
  Written *Next;
};

std::atomic<Written *> Files;
std::atomic<bool> Following{true};
char *Failure; // the first message
std::mutex Lock;

void fail(const char *Message) {
  const std::lock_guard<std::mutex> Held(Lock);
  if (!Failure)
    Failure = strdup(Message);
}

Written *find(const char *Path) {
  Written *File = Files.load();
  while (File && strcmp(File->Path, Path) != 0)
    File = File->Next;
  return File;
}

bool isOwn(const char *Path) {
  const Written *File = find(Path);
  return File && File->Now == Written::Own;
}

void add(Written::State State, int Memory, bool Appended, const char *Path) {
  const std::lock_guard<std::mutex> Held(Lock);
  Files = new Written{State, Memory, Appended, strdup(Path), Files.load()};
}

/// The contents of a descriptor.
struct Contents {
  void *Bytes = nullptr;
  size_t Size = 0;
  explicit Contents(int Descriptor) {
    struct stat Status;
    if (Descriptor < 0 || fstat(Descriptor, &Status) != 0 || Status.st_size == 0)
      return;
    Bytes = mmap(nullptr, size_t(Status.st_size), PROT_READ, MAP_SHARED, Descriptor, 0);
    Size = size_t(Status.st_size);
  }
  bool valid() const { return Bytes != MAP_FAILED; }
  ~Contents() {
    if (Size && valid())
      munmap(Bytes, Size);
  }
};

bool write(const char *Path, const Contents &From, bool Executable) {
  trax_error Reason;
  const bool Good = From.valid() && trax_write_whole(Path, From.Bytes, From.Size, Executable, &Reason) == TRAX_OK;
  if (!Good)
    fail(From.valid() ? Reason.message : "out of memory");
  return Good;
}

int systemOpen(const char *Path, int Flags, mode_t Mode) {
  return int(syscall(SYS_openat, AT_FDCWD, Path, Flags, Mode));
}

/// Several compilers may append to one file at the same time, so it is not replaced. One call adds everything or
/// nothing.
void append(const char *Path, const Contents &From) {
  struct stat Status = {};
  const bool Exists = stat(Path, &Status) == 0;
  if (trax_output_descriptor(Path) >= 0 || !Exists || !S_ISREG(Status.st_mode)) {
    write(Path, From, false);
    return;
  }
  char Message[512] = "";
  const int File = trax_reads_has(&Status) ? -1 : systemOpen(Path, O_WRONLY | O_APPEND | O_CLOEXEC, 0);
  if (trax_reads_has(&Status))
    snprintf(Message, sizeof Message, "%.300s: is an input and the output", Path);
  else if (File < 0 || !From.valid())
    snprintf(Message, sizeof Message, "%.300s: cannot be written: %s", Path, strerror(errno));
  else if (const ssize_t Got = ::write(File, From.Bytes, From.Size); Got != ssize_t(From.Size)) {
    snprintf(Message, sizeof Message, "%.300s: cannot be written: %s", Path, strerror(Got < 0 ? errno : ENOSPC));
    struct stat Now;
    if (Got > 0 && fstat(File, &Now) == 0 && Now.st_size == Status.st_size + Got &&
        ftruncate(File, Status.st_size) != 0)
      fail(Message);
  }
  if (File >= 0)
    close(File);
  if (*Message)
    fail(Message);
}

} // namespace

void trax::followRule(bool Follow) {
  Following = Follow;
}

const void *trax::outputsSoFar() {
  return Files.load();
}

bool trax::commitOutputs(const char *Program, bool Keep, const void *Since) {
  for (Written *File = Files.load(); File && File != Since; File = File->Next) {
    Written::State Before = Written::Collected;
    if (!File->Now.compare_exchange_strong(Before, Written::Dropped))
      continue;
    if (const Contents From(File->Memory); Keep && File->Appended)
      append(File->Path, From);
    else if (Keep)
      write(File->Path, From, false);
    close(File->Memory);
  }
  if (!Failure)
    return true;
  trax_message(Program, TRAX_MESSAGE_ERROR, "%s", Failure);
  free(Failure);
  Failure = nullptr;
  return false;
}

namespace {

/// LLVM removes only its own files. The earlier file of an output's name stays: if that output failed, its contents are
/// dropped.
bool isKept(const char *Path) {
  Written *File = find(Path);
  struct stat Status;
  if (!Following || (File && File->Now == Written::Own))
    return false;
  if (File && File->Now == Written::Collected)
    File->Now = Written::Dropped;
  if (File)
    return true;
  if (lstat(Path, &Status) != 0 || S_ISDIR(Status.st_mode))
    return false;
  add(Written::Removed, -1, false, Path);
  return true;
}

/// Whether the file is endless, like /dev/zero: LLVM would read it until memory is full.
bool isEndless(int Descriptor, const struct stat &Status) {
  struct stat Null;
  return S_ISCHR(Status.st_mode) && !isatty(Descriptor) &&
         !(stat("/dev/null", &Null) == 0 && Null.st_rdev == Status.st_rdev);
}

/// A descriptor for the contents that Path will get. LLVM reports an errno with the file's name; commitOutputs reports
/// a file that was read.
int collect(const char *Path, bool Appended, const struct stat *Existing) {
  trax_error Reason;
  errno = 0;
  const Written *Before = find(Path);
  Appended = Appended && !(Before && Before->Now == Written::Removed);
  if (Existing && trax_reads_has(Existing)) {
  } else if (Appended && Existing ? access(Path, W_OK) != 0 : trax_output_check(Path, &Reason) != TRAX_OK) {
    return errno ? -1 : (errno = EACCES, -1);
  }
  const int Memory = memfd_create("output", MFD_CLOEXEC), Copy = Memory < 0 ? -1 : fcntl(Memory, F_DUPFD_CLOEXEC, 0);
  if (Copy >= 0) {
    add(Written::Collected, Copy, Appended, Path);
  } else if (Memory >= 0) {
    const int Reason = errno;
    close(Memory);
    errno = Reason;
    return -1;
  }
  return Memory;
}

} // namespace

// The linker makes the shared libraries call these, since the program defines them.
extern "C" {

__attribute__((visibility("default"))) int open(const char *Path, int Flags, ...) {
  va_list Arguments;
  va_start(Arguments, Flags);
  const mode_t Mode = Flags & (O_CREAT | O_TMPFILE) ? va_arg(Arguments, mode_t) : 0;
  va_end(Arguments);
  struct stat Status;
  trax_reads_begin();
  const bool Writes = (Flags & O_ACCMODE) != O_RDONLY, Fresh = (Flags & (O_CREAT | O_EXCL)) == (O_CREAT | O_EXCL);
  const bool Replaces = Following && Writes && !Fresh && Flags & (O_TRUNC | O_APPEND) && !isOwn(Path);
  const bool Exists = Replaces && stat(Path, &Status) == 0;
  if (Replaces && (Exists ? S_ISREG(Status.st_mode) : (Flags & O_CREAT) != 0))
    return collect(Path, Flags & O_APPEND, Exists ? &Status : nullptr);
  const int Opened = systemOpen(Path, Flags, Mode);
  if (Opened >= 0 && !Writes && fstat(Opened, &Status) == 0) {
    trax_reads_note(&Status);
    if (isEndless(Opened, Status)) {
      close(Opened);
      errno = EINVAL;
      return -1;
    }
  } else if (Opened >= 0 && (Fresh || Replaces)) {
    add(Fresh ? Written::Own : Written::Direct, -1, false, Path);
  }
  return Opened;
}

__attribute__((visibility("default"))) int rename(const char *From, const char *To) noexcept {
  if (!Following || !isOwn(From))
    return int(syscall(SYS_rename, From, To));
  const int File = systemOpen(From, O_RDONLY | O_CLOEXEC, 0);
  struct stat Status;
  if (File < 0 || fstat(File, &Status) != 0)
    return -1;
  write(To, Contents(File), Status.st_mode & 0111);
  close(File);
  return int(syscall(SYS_unlink, From));
}

__attribute__((visibility("default"))) int unlink(const char *Path) noexcept {
  return isKept(Path) ? 0 : int(syscall(SYS_unlink, Path));
}

__attribute__((visibility("default"))) int remove(const char *Path) noexcept {
  if (isKept(Path))
    return 0;
  const int Result = int(syscall(SYS_unlink, Path));
  return Result != 0 && errno == EISDIR ? int(syscall(SYS_rmdir, Path)) : Result;
}
}
