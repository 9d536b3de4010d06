/* Macros that select the names which headers declare, and that declare missing functions. */
#ifndef TRAX_NAMES_H
#define TRAX_NAMES_H

/* C's headers also declare the names of POSIX, of GNU and of this library, unless the program asks for plain C
   (-std=c17) and for none of them. */
#if !defined __STRICT_ANSI__ || defined __cplusplus || defined _GNU_SOURCE || defined _DEFAULT_SOURCE ||               \
    defined _BSD_SOURCE || defined _POSIX_SOURCE || defined _POSIX_C_SOURCE || defined _XOPEN_SOURCE
#define __TRAX_ALL_NAMES 1
#endif

/* Declares a function that fails with ENOSYS, so that programs compile. It is not in the library, so configure scripts
   do not find it. __TRAX_REFUSES also warns of calls. */
#ifdef __trax__
#define __TRAX_FAILS(type, name, parameters, result)                                                                   \
  __attribute__((__unused__)) static __inline type name parameters {                                                   \
    __trax_not_here();                                                                                                 \
    return result;                                                                                                     \
  }
#define __TRAX_REFUSES(type, name, parameters, result, why)                                                            \
  __attribute__((diagnose_if(1, "'" #name "' fails with ENOSYS: " why, "warning"))) __TRAX_FAILS(type, name,           \
                                                                                                 parameters, result)
#else
#define __TRAX_FAILS(type, name, parameters, result) type name parameters;
#define __TRAX_REFUSES(type, name, parameters, result, why) type name parameters;
#endif
#ifdef __cplusplus
extern "C" void __trax_not_here(void);
#else
void __trax_not_here(void);
#endif

#endif
