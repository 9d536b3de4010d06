#include <stdio.h>
int function(void);
int part(int);
int main(void) {
  printf("%d\n", part(function()));
  return 0;
}
