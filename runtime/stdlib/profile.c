/* The counters of -fprofile-instr-generate, written at the program's end as a raw profile of LLVM 19 (version 10 of
   llvm/ProfileData/InstrProfData.inc): header, records of functions, counters, names, each padded to 8 bytes. */
#include <stdint.h>
#include <string.h>

#include "../internal/host.h"

int __llvm_profile_runtime; /* what the compiler and the driver refer to */
__attribute__((weak)) const char __llvm_profile_filename[] = "default.profraw"; /* or as the compiler has it */

struct record { /* of a function */
  uint64_t name, hash;
  uint32_t counters, bitmap, function, values, count;
  uint16_t value_sites[3];
  uint32_t bitmap_bytes;
};

#define SECTION(NAME) extern __attribute__((weak)) const char __start___llvm_prf_##NAME[], __stop___llvm_prf_##NAME[]
SECTION(data);
SECTION(cnts);
SECTION(bits);
SECTION(names);

static int file;

static int put(const void *memory, unsigned bytes) {
  for (int done; bytes; memory = (const char *)memory + done, bytes -= (unsigned)done)
    if ((done = host_call(TRAX_HOST_WRITE, (unsigned)file, (uintptr_t)memory, bytes)) < 0)
      return done;
  return 0;
}

static unsigned padding(unsigned bytes) {
  return -bytes & 7;
}

static int put_padded(const char *begin, unsigned bytes) {
  static const char zeros[8];
  const int failed = put(begin, bytes);
  return failed ? failed : put(zeros, padding(bytes));
}

/* Without a stream, which a stack in local memory has no room for. */
static void complain(int number) {
  const char *const parts[] = {"profile: ", __llvm_profile_filename, " cannot be written: ", strerror(number),
                               "; it must be in a folder of trax-sim's --dir\n"};
  file = 2;
  for (unsigned i = 0; i < sizeof parts / sizeof *parts; i++)
    put(parts[i], strlen(parts[i]));
}

__attribute__((destructor)) static void write_profile(void) {
  const unsigned data = (unsigned)(__stop___llvm_prf_data - __start___llvm_prf_data);
  const unsigned counters = (unsigned)(__stop___llvm_prf_cnts - __start___llvm_prf_cnts);
  const unsigned bits = (unsigned)(__stop___llvm_prf_bits - __start___llvm_prf_bits);
  const unsigned names = (unsigned)(__stop___llvm_prf_names - __start___llvm_prf_names);
  const uint64_t header[] = {0xFF6C70726F665281, /* "\xFFlprofR\x81": of 32 bits */
                             10,
                             0, /* no binary ids */
                             data / sizeof(struct record),
                             0,
                             counters / sizeof(uint64_t),
                             padding(counters),
                             bits,
                             padding(bits),
                             names,
                             (uintptr_t)__start___llvm_prf_cnts - (uintptr_t)__start___llvm_prf_data,
                             (uintptr_t)__start___llvm_prf_bits - (uintptr_t)__start___llvm_prf_data,
                             (uintptr_t)__start___llvm_prf_names,
                             0, /* no tables of virtual functions */
                             0,
                             2};
  file = host_call(TRAX_HOST_OPEN, (uintptr_t)__llvm_profile_filename,
                   TRAX_OPEN_WRITE | TRAX_OPEN_CREATE | TRAX_OPEN_TRUNCATE, 0);
  int failed = file < 0 ? file : put(header, sizeof header);
  failed = failed ? failed : put_padded(__start___llvm_prf_data, data);
  failed = failed ? failed : put_padded(__start___llvm_prf_cnts, counters);
  failed = failed ? failed : put_padded(__start___llvm_prf_bits, bits);
  failed = failed ? failed : put_padded(__start___llvm_prf_names, names);
  if (file >= 0) {
    const int closed = host_call(TRAX_HOST_CLOSE, (unsigned)file, 0, 0);
    failed = failed ? failed : closed;
  }
  if (failed < 0)
    complain(-failed);
}
