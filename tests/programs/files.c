/* Operations on files for calls_test.py, a word after the other: see main. Each prints its result. */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#ifdef __trax__
#include <trax.h>
#else
static unsigned trax_thread(void) {
  return 0;
}
#endif

static void report(const char *what, const char *name, int good) {
  printf("%s %s: %s\n", what, name, good ? "good" : strerror(errno));
}

static void print_file(const char *name) {
  FILE *file = fopen(name, "r");
  report("read", name, file != NULL);
  char line[64];
  while (file && fgets(line, sizeof line, file))
    printf("  %s", line);
  if (file && ferror(file))
    report("read from", name, 0);
  if (file)
    fclose(file);
}

static void write_file(const char *name, const char *mode, const char *text) {
  FILE *file = fopen(name, mode);
  if (file)
    fputs(text, file);
  const int closed = file && fclose(file) == 0;
  report("write", name, closed);
}

/* Reads, writes and seeks in one file, as a buffer sees it and as the file is. */
static void update(const char *name) {
  FILE *file = fopen(name, "w+");
  if (!file)
    return report("update", name, 0);
  for (int i = 0; i < 130; i++) /* more than a buffer of 4096 bytes */
    fprintf(file, "%d,%40s", i, "");
  fseek(file, 10, SEEK_SET);
  int number = -1;
  const int got = fscanf(file, "%d", &number);
  printf("%d %d %ld\n", got, number, ftell(file));
  fseek(file, 0, SEEK_CUR);
  fputs("<here>", file);
  fseek(file, -4, SEEK_END);
  char tail[8] = "";
  fread(tail, 1, 4, file);
  printf("%s %d %ld\n", tail, feof(file), ftell(file));
  rewind(file);
  printf("%c", fgetc(file));
  ungetc('x', file);
  printf("%c", fgetc(file));
  printf(" %d\n", ferror(file));
  report("close", name, fclose(file) == 0);
  struct stat status;
  report("stat", name, stat(name, &status) == 0);
  printf("%lld %d\n", (long long)status.st_size, S_ISREG(status.st_mode));
}

static void descriptors(const char *name) {
  const int file = open(name, O_RDWR | O_CREAT | O_TRUNC, 0666);
  report("open", name, file >= 0);
  printf("%d", (int)write(file, "0123456789", 10));
  printf(" %d", (int)lseek(file, 3, SEEK_SET));
  printf(" %d\n", (int)lseek(file, 0, SEEK_END));
  char text[8] = "";
  lseek(file, -4, SEEK_CUR);
  printf("%d", (int)read(file, text, 7));
  printf(" %s", text);
  printf(" %d", ftruncate(file, 5));
  printf(" %d\n", close(file));
  printf("%d", (int)read(file, text, 1));
  printf(" %d\n", errno == EBADF);
}

static void count_input(void) {
  int lines = 0;
  unsigned sum = 0;
  for (int c; (c = getchar()) != EOF; sum = sum * 31 + (unsigned)c)
    lines += c == '\n';
  printf("input: %d lines, %u\n", lines, sum);
}

/* Lines of input as they come, with work in between, and a copy that is written at the end. */
static void copy_input(const char *name) {
  char line[64];
  FILE *file = fopen(name, "w");
  volatile unsigned work = 0;
  while (fgets(line, sizeof line, stdin)) {
    for (int i = 0; i < 300; i++)
      work += (unsigned)i;
    printf("> %s", line);
    if (file)
      fputs(line, file);
  }
  report("copy", name, file && fclose(file) == 0);
}

/* Standard output goes to a file, to nothing and back. */
static void reopen(const char *name) {
  fflush(stdout);
  const int kept = dup(1);
  const int is_file = freopen(name, "w", stdout) == stdout;
  puts("in the file");
  for (int i = 0; i < 40; i++)
    printf("%d%c", i, i % 8 == 7 ? '\n' : ' ');
  for (int i = 0; i < 3000; i++) /* in epochs of the fast engine */
    putchar('a' + i % 26);
  fflush(stdout);
  const int is_nothing = freopen("/dev/null", "w", stdout) == stdout;
  puts("nowhere");
  fflush(stdout);
  dup2(kept, 1);
  close(kept);
  report("reopen", name, is_file && is_nothing);
  FILE *file = fopen("/dev/null", "r+");
  printf("%d %d\n", fgetc(file), fputs("lost", file) >= 0);
  fclose(file);
}

int main(int argc, char **argv) {
  if (trax_thread() != 0)
    return 0;
  for (int i = 1; i < argc; i++) {
    const char *what = argv[i], *name = i + 1 < argc ? argv[i + 1] : "";
    if (strcmp(what, "arguments") == 0) {
      for (int k = 0; k < argc; k++)
        printf("[%s]", argv[k]);
      printf(" %d\n", argv[argc] == NULL);
      return argc;
    }
    if (strcmp(what, "input") == 0) {
      count_input();
      continue;
    }
    if (strcmp(what, "fault") == 0)
      *(volatile int *)4 = 1;
    if (strcmp(what, "spin") == 0)
      for (;;)
        __asm__ volatile("");
    i++;
    if (strcmp(what, "read") == 0)
      print_file(name);
    else if (strcmp(what, "write") == 0)
      write_file(name, "w", "first\n");
    else if (strcmp(what, "append") == 0)
      write_file(name, "a", "more\n");
    else if (strcmp(what, "open") == 0) {
      FILE *file = fopen(name, "w"); /* and is left so */
      report("open", name, file && fputs("open\n", file) >= 0);
    } else if (strcmp(what, "exclusive") == 0)
      write_file(name, "wx", "new\n");
    else if (strcmp(what, "update") == 0)
      update(name);
    else if (strcmp(what, "descriptors") == 0)
      descriptors(name);
    else if (strcmp(what, "remove") == 0)
      report(what, name, remove(name) == 0);
    else if (strcmp(what, "folder") == 0)
      report(what, name, mkdir(name, 0777) == 0);
    else if (strcmp(what, "rename") == 0)
      report(what, name, i + 1 < argc && rename(name, argv[++i]) == 0);
    else if (strcmp(what, "reopen") == 0)
      reopen(name);
    else if (strcmp(what, "copy") == 0)
      copy_input(name);
    else
      fprintf(stderr, "%s: unknown\n", what);
  }
  return 0;
}
