/* Messages of error numbers, as glibc has them, and of signals. */
#include <errno.h>
#include <string.h>

char *strerror(int number) {
  static const char *const texts[] = {
      [0] = "Success",
      [EPERM] = "Operation not permitted",
      [ENOENT] = "No such file or directory",
      [EINTR] = "Interrupted system call",
      [EIO] = "Input/output error",
      [E2BIG] = "Argument list too long",
      [EBADF] = "Bad file descriptor",
      [EAGAIN] = "Resource temporarily unavailable",
      [ENOMEM] = "Cannot allocate memory",
      [EACCES] = "Permission denied",
      [EFAULT] = "Bad address",
      [EBUSY] = "Device or resource busy",
      [EEXIST] = "File exists",
      [EXDEV] = "Invalid cross-device link",
      [ENODEV] = "No such device",
      [ENOTDIR] = "Not a directory",
      [EISDIR] = "Is a directory",
      [EINVAL] = "Invalid argument",
      [EMFILE] = "Too many open files",
      [ENOTTY] = "Inappropriate ioctl for device",
      [EFBIG] = "File too large",
      [ENOSPC] = "No space left on device",
      [ESPIPE] = "Illegal seek",
      [EROFS] = "Read-only file system",
      [EPIPE] = "Broken pipe",
      [EDOM] = "Numerical argument out of domain",
      [ERANGE] = "Numerical result out of range",
      [EDEADLK] = "Resource deadlock avoided",
      [ENAMETOOLONG] = "File name too long",
      [ENOSYS] = "Function not implemented",
      [ENOTEMPTY] = "Directory not empty",
      [ELOOP] = "Too many levels of symbolic links",
      [EOVERFLOW] = "Value too large for defined data type",
      [EILSEQ] = "Invalid or incomplete multibyte or wide character",
      [ENOTSUP] = "Operation not supported",
      [ETIMEDOUT] = "Connection timed out",
  };
  unsigned i = (unsigned)number;
  return (char *)(i < sizeof texts / sizeof *texts && texts[i] ? texts[i] : "Unknown error");
}

int strerror_r(int number, char *to, size_t size) {
  return strlcpy(to, strerror(number), size) < size ? 0 : ERANGE;
}

char *strsignal(int number) {
  (void)number;
  return "signal";
}
