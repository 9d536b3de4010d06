/* Error numbers; each thread has its own errno. Only strtol and its like set it. */
#ifndef TRAX_ERRNO_H
#define TRAX_ERRNO_H

#define EDOM 33
#define ERANGE 34
#define EILSEQ 84
#define EINVAL 22
#define ENOMEM 12

#ifdef __cplusplus
extern "C" {
#endif
extern __thread int errno;

#ifdef __cplusplus
}
#endif

#endif
