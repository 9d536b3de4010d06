// RUN: %run_c %s %t --turns -O0,-O2 --cflags "-mstack=global"
// sscanf into wide characters: %ls, %lc, %l[, of one to four bytes each. (Expected output by hand: glibc gives 0 instead of EOF
// for what is no character.)
#include <errno.h>
#include <locale.h>
#include <stdio.h>
#include <wchar.h>

static void show(int done, const wchar_t *text, int count) {
  printf("%d:", done);
  for (int i = 0; i < count; i++)
    printf(" %x", (unsigned)text[i]);
  putchar('\n');
}

int main(void) {
  setlocale(LC_ALL, "C.UTF-8");
  wchar_t a[16] = {0}, b[16] = {0};
  char rest[16] = "";
  int end = 0;
  show(sscanf("abc \xc3\xa4\xe2\x82\xac\xf0\x9f\x98\x80 x", "%ls%ls%n", a, b, &end), b, 4);
  show(end, a, 4);
  show(sscanf("\xc3\xa4\xc3\xb6", "%lc", a), a, 1);
  show(sscanf("\xc3\xa4\xc3\xb6z", "%2lc%s", a, rest), a, 2);
  puts(rest);
  show(sscanf("\xc3\xa4z\xc3\xb6!", "%l[a-z\xc3\xa4-\xc3\xb6]%s", a, rest), a, 4);
  puts(rest);
  show(sscanf("xy\xe2\x82\xacz", "%l[^\xe2\x82\xac]%s", a, rest), a, 3);
  puts(rest);
  show(sscanf("abcdef", "%3ls%s", a, rest), a, 4);
  puts(rest);
  show(sscanf("ab cd", "%*ls%ls", a), a, 3);
  show(sscanf("pq r", "%S%C", a, b), a, 3);
  errno = 0;
  int got = sscanf("\xff", "%ls", a);
  printf("%d %d\n", got, errno == EILSEQ);
  errno = 0;
  got = sscanf("\xc3", "%lc", a);
  printf("%d %d\n", got, errno == EILSEQ);
  return 0;
}
