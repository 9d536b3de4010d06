# Powers and logarithms of binary64, complex numbers, and erff are newlib's: Debian's package newlib-source has its sources, which are unpacked into the build folder and compiled like ours. docs/runtime.md lists them.

set(NEWLIB_VERSIONS 3.3.0 4.5.0) # those of Debian 12 and 13: what is compiled below has the same code in both
file(GLOB NEWLIB_FOUND /usr/src/newlib/newlib-*.tar.xz)
if(NEWLIB_FOUND)
  list(GET NEWLIB_FOUND 0 NEWLIB_FOUND)
endif()
set(TRAX_NEWLIB "${NEWLIB_FOUND}" CACHE FILEPATH "The archive of newlib's sources")
if(NOT EXISTS "${TRAX_NEWLIB}")
  message(FATAL_ERROR "newlib's sources are not at /usr/src/newlib: install the package newlib-source, or say -DTRAX_NEWLIB=newlib-VERSION.tar.xz")
endif()
set(NEWLIB_DIR ${CMAKE_CURRENT_BINARY_DIR}/newlib)
file(SHA256 ${TRAX_NEWLIB} NEWLIB_HASH)
file(SHA256 ${CMAKE_CURRENT_LIST_FILE} NEWLIB_HOW)
string(APPEND NEWLIB_HASH " ${NEWLIB_HOW}")
set(NEWLIB_UNPACKED "")
if(EXISTS ${NEWLIB_DIR}/unpacked)
  file(READ ${NEWLIB_DIR}/unpacked NEWLIB_UNPACKED)
endif()
if(NOT NEWLIB_UNPACKED STREQUAL NEWLIB_HASH)
  message(STATUS "Unpacking ${TRAX_NEWLIB}")
  file(REMOVE_RECURSE ${NEWLIB_DIR})
  file(ARCHIVE_EXTRACT INPUT ${TRAX_NEWLIB} DESTINATION ${NEWLIB_DIR}
    PATTERNS */newlib/ac*.m4 */newlib/libm/common/* */newlib/libm/math/* */newlib/libm/complex/* */COPYING.NEWLIB)
  file(GLOB NEWLIB_TOP ${NEWLIB_DIR}/*)
  set(NEWLIB_FOUND_VERSION "")
  if(EXISTS "${NEWLIB_TOP}/newlib/acinclude.m4")
    file(STRINGS ${NEWLIB_TOP}/newlib/acinclude.m4 NEWLIB_PARTS REGEX "NEWLIB_(MAJOR|MINOR|PATCHLEVEL)_VERSION\\],\\[[0-9]+\\]")
    list(TRANSFORM NEWLIB_PARTS REPLACE ".*VERSION\\],\\[([0-9]+)\\].*" "\\1")
    list(JOIN NEWLIB_PARTS . NEWLIB_FOUND_VERSION)
  endif()
  if(NOT NEWLIB_FOUND_VERSION)
    file(REMOVE_RECURSE ${NEWLIB_DIR})
    message(FATAL_ERROR "${TRAX_NEWLIB} does not have newlib's version where 3.3.0 and 4.5.0 have it: say -DTRAX_NEWLIB=newlib-4.5.0.tar.xz")
  elseif(NOT NEWLIB_FOUND_VERSION IN_LIST NEWLIB_VERSIONS)
    list(JOIN NEWLIB_VERSIONS " and " NEWLIB_TRIED)
    message(WARNING "${TRAX_NEWLIB} is newlib ${NEWLIB_FOUND_VERSION}; ${NEWLIB_TRIED} were tried. Run ctest -R numerics")
  endif()
  # 3.3.0 takes the unit circle for a pole of the arc tangent.
  foreach(name catan catanf)
    file(READ ${NEWLIB_TOP}/newlib/libm/complex/${name}.c NEWLIB_TEXT)
    string(REGEX REPLACE "(a = 1[.]0f? - x2 - [(]y [*] y[)];)[ \t\n]*if [(]a == 0[.]0f?[)][ \t\n]*goto ovrf;" "\\1" NEWLIB_TEXT "${NEWLIB_TEXT}")
    file(WRITE ${NEWLIB_TOP}/newlib/libm/complex/${name}.c "${NEWLIB_TEXT}")
  endforeach()
  file(RENAME ${NEWLIB_TOP}/newlib/libm ${NEWLIB_DIR}/libm)
  file(RENAME ${NEWLIB_TOP}/COPYING.NEWLIB ${NEWLIB_DIR}/COPYING.NEWLIB)
  file(REMOVE_RECURSE ${NEWLIB_TOP})
  file(WRITE ${NEWLIB_DIR}/unpacked ${NEWLIB_HASH})
endif()
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${TRAX_NEWLIB} ${NEWLIB_DIR}/unpacked)

set(NEWLIB_C
  # binary64
  common/s_cbrt common/exp common/exp2 common/exp_data common/log common/log_data common/log2 common/log2_data common/pow
  common/pow_log_data common/math_err
  # binary32
  math/sf_erf
  common/math_errf
  complex/cephes_subr complex/cephes_subrf)
set(COMPLEX_NAMES cabs cacos cacosh carg casin casinh catan catanh ccos ccosh cexp cimag clog conj cpow cproj creal csin csinh
    csqrt ctan ctanh)
foreach(name ${COMPLEX_NAMES})
  list(APPEND NEWLIB_C complex/${name} complex/${name}f)
endforeach()
list(TRANSFORM NEWLIB_C APPEND .c)
list(TRANSFORM NEWLIB_C PREPEND ${NEWLIB_DIR}/libm/)

# Our headers replace newlib's own. We do not warn about its code.
set(NEWLIB_FLAGS -w -include ${CMAKE_CURRENT_LIST_DIR}/config.h -I${CMAKE_CURRENT_LIST_DIR} -I${NEWLIB_DIR}/libm/common)
file(GLOB NEWLIB_HEADERS CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/*.h ${CMAKE_CURRENT_LIST_DIR}/*/*.h)

# The functions of long double, which is binary64, are jumps to those of double.
set(LONG_DOUBLE_NAMES
  acos acosh asin asinh atan atan2 atanh cbrt ceil copysign cos cosh erf erfc exp exp2 expm1 fabs fdim floor fma fmax fmin fmod
  frexp hypot ilogb ldexp lgamma llrint llround log log10 log1p log2 logb lrint lround modf nan nearbyint nextafter nexttoward pow
  remainder remquo rint round scalbln scalbn sin sinh sqrt tan tanh tgamma trunc
  ${COMPLEX_NAMES})
