// RUN: %run_c %s %t
// String functions on the machine.
#include <ctype.h>
#include <stdio.h>
#include <string.h>

static char buffer[64], other[64];

int main(void) {
  strcpy(buffer, "ray");
  strcat(buffer, " tracing");
  printf("%s %d %d\n", buffer, (int)strlen(buffer), (int)strlen(buffer + 1));
  printf("%d %d %d\n", strcmp("abc", "abc"), strcmp("abc", "abd") < 0, strcmp("b", "abc") > 0);
  printf("%d %d\n", strncmp("abcdef", "abcxyz", 3), strncmp("abcdef", "abcxyz", 4) < 0);
  printf("%s %s %d\n", strchr(buffer, 't'), strrchr(buffer, 'r'), strchr(buffer, 'z') == NULL);
  printf("%s %d %d\n", strstr(buffer, "trac"), (int)strspn(buffer, "yar"), (int)strcspn(buffer, "gt"));
  strncpy(other, "truncated", 5);
  strncat(other, " and more", 4);
  printf("%s|\n", other);
  char *rest;
  strcpy(other, "a,bc,,def");
  for (char *token = strtok_r(other, ",", &rest); token; token = strtok_r(NULL, ",", &rest))
    printf("<%s>", token);
  puts("");
  for (char *p = buffer; *p; p++)
    *p = (char)(isalpha(*p) ? toupper(*p) : isspace(*p) ? '_' : *p);
  puts(buffer);
  return 0;
}
