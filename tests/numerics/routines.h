/* The runtime's support routines as they are called when compiled for the host (CMakeLists.txt): with the prefix rt_.
 */
#ifndef TRAX_NUMERICS_ROUTINES_H
#define TRAX_NUMERICS_ROUTINES_H

#include <stdint.h>

uint32_t rt___udivsi3(uint32_t, uint32_t);
uint32_t rt___umodsi3(uint32_t, uint32_t);
uint32_t rt___udivmodsi4(uint32_t, uint32_t, uint32_t *);
int32_t rt___divsi3(int32_t, int32_t);
int32_t rt___modsi3(int32_t, int32_t);
int32_t rt___divmodsi4(int32_t, int32_t, int32_t *);
uint64_t rt___udivdi3(uint64_t, uint64_t);
uint64_t rt___umoddi3(uint64_t, uint64_t);
uint64_t rt___udivmoddi4(uint64_t, uint64_t, uint64_t *);
int64_t rt___divdi3(int64_t, int64_t);
int64_t rt___moddi3(int64_t, int64_t);
int64_t rt___divmoddi4(int64_t, int64_t, int64_t *);
uint64_t rt___ashldi3(uint64_t, int);
uint64_t rt___lshrdi3(uint64_t, int);
int64_t rt___ashrdi3(int64_t, int);
uint64_t rt___muldi3(uint64_t, uint64_t);
int rt___cmpdi2(int64_t, int64_t);
int rt___ucmpdi2(uint64_t, uint64_t);
uint64_t rt___negdi2(uint64_t);
int rt___clzsi2(uint32_t);
int rt___clzdi2(uint64_t);
int rt___ctzsi2(uint32_t);
int rt___ctzdi2(uint64_t);
int rt___ffssi2(uint32_t);
int rt___ffsdi2(uint64_t);
int rt___popcountsi2(uint32_t);
int rt___popcountdi2(uint64_t);
int rt___paritysi2(uint32_t);
int rt___paritydi2(uint64_t);
uint32_t rt___bswapsi2(uint32_t);
uint64_t rt___bswapdi2(uint64_t);
double rt___adddf3(double, double);
double rt___subdf3(double, double);
double rt___muldf3(double, double);
double rt___divdf3(double, double);
double rt___negdf2(double);
int rt___eqdf2(double, double);
int rt___nedf2(double, double);
int rt___ltdf2(double, double);
int rt___ledf2(double, double);
int rt___gtdf2(double, double);
int rt___gedf2(double, double);
int rt___cmpdf2(double, double);
int rt___unorddf2(double, double);
int rt___eqsf2(float, float);
int rt___nesf2(float, float);
int rt___ltsf2(float, float);
int rt___lesf2(float, float);
int rt___gtsf2(float, float);
int rt___gesf2(float, float);
int rt___unordsf2(float, float);
double rt___extendsfdf2(float);
float rt___truncdfsf2(double);
int32_t rt___fixdfsi(double);
uint32_t rt___fixunsdfsi(double);
int64_t rt___fixdfdi(double);
uint64_t rt___fixunsdfdi(double);
int64_t rt___fixsfdi(float);
uint64_t rt___fixunssfdi(float);
double rt___floatsidf(int32_t);
double rt___floatunsidf(uint32_t);
double rt___floatdidf(int64_t);
double rt___floatundidf(uint64_t);
float rt___floatdisf(int64_t);
float rt___floatundisf(uint64_t);
float rt___powisf2(float, int);
double rt___powidf2(double, int);
float _Complex rt___mulsc3(float, float, float, float);
float _Complex rt___divsc3(float, float, float, float);
double _Complex rt___muldc3(double, double, double, double);
double _Complex rt___divdc3(double, double, double, double);
float rt___extendhfsf2(uint16_t);
uint16_t rt___truncsfhf2(float);
uint16_t rt___truncdfhf2(double);
int64_t rt___mulodi4(int64_t, int64_t, int *);
double rt_sqrt(double);
double rt_fma(double, double, double);
double rt_pow(double, double);
double rt_atan2(double, double);
double rt_hypot(double, double);
double rt_fmod(double, double);
double rt_remainder(double, double);

#endif
