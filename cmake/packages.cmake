# Outside libraries, all from the distribution's packages (tools/packages lists their names). Each is looked for where a
# target that needs it is configured, and a missing one is reported in one line with the package that brings it.

# kadr_missing(WHAT PACKAGE PURPOSE): ends the configuration with the one line that a reader needs.
function(kadr_missing what package purpose)
  message(FATAL_ERROR "${purpose} needs ${what}: install the Debian package ${package} (`tools/setup` installs all)")
endfunction()

# kadr_package(NAME PACKAGE PURPOSE [find_package arguments]): a library with a CMake package of its own.
macro(kadr_package name package purpose)
  find_package(${name} ${ARGN} QUIET)
  if(NOT ${name}_FOUND)
    string(REGEX MATCH "[0-9.]+" least "${ARGN}")
    kadr_missing("${name} ${least}" ${package} "${purpose}")
  endif()
endmacro()

# kadr_library(TARGET HEADER LIBRARY ... [OPTIONAL] [PACKAGE P PURPOSE TEXT]): external::TARGET from a header and libraries found
# by file, for libraries whose own package files ask for more than they need. With OPTIONAL a missing one leaves no target.
function(kadr_library target header)
  cmake_parse_arguments(ARG "OPTIONAL" "PACKAGE;PURPOSE" "" ${ARGN})
  find_path(${target}_INCLUDE ${header})
  set(files)
  set(found ${${target}_INCLUDE})
  foreach(library ${ARG_UNPARSED_ARGUMENTS})
    find_library(${library}_LIBRARY ${library})
    list(APPEND files ${${library}_LIBRARY})
    if(NOT ${library}_LIBRARY)
      set(found)
    endif()
  endforeach()
  if(NOT found)
    if(ARG_OPTIONAL)
      return()
    endif()
    kadr_missing(${target} ${ARG_PACKAGE} "${ARG_PURPOSE}")
  endif()
  add_library(kadr_external_${target} INTERFACE)
  add_library(external::${target} ALIAS kadr_external_${target})
  target_include_directories(kadr_external_${target} SYSTEM INTERFACE ${${target}_INCLUDE})
  target_link_libraries(kadr_external_${target} INTERFACE ${files})
endfunction()

kadr_package(Eigen3 libeigen3-dev kadr 3.4 NO_MODULE)
kadr_package(fmt libfmt-dev kadr 9)
kadr_package(tl-expected libexpected-dev kadr)
kadr_package(tomlplusplus libtomlplusplus-dev kadr)
kadr_package(nlohmann_json nlohmann-json3-dev kadr)
kadr_package(Threads libc6-dev kadr)
kadr_package(ZLIB zlib1g-dev kadr)
if(KADR_CLI)
  kadr_package(CLI11 libcli11-dev "the program kadr")
endif()
# SUNDIALS' package file asks for MPI, and for OpenMP of the compiler in use; CVODE with serial vectors needs neither. It is
# linked in: the shared library brings Fortran's run-time library for an interface that nobody calls here.
kadr_library(cvode cvode/cvode.h libsundials_cvode.a PACKAGE libsundials-dev PURPOSE kadr)
file(STRINGS ${cvode_INCLUDE}/sundials/sundials_config.h sundials_major REGEX "#define SUNDIALS_VERSION_MAJOR")
string(REGEX REPLACE "[^0-9]" "" sundials_major "${sundials_major}")
if(sundials_major LESS 6)
  kadr_missing("SUNDIALS 6 (found ${sundials_major})" libsundials-dev kadr)
endif()
# lcm.pc asks for GLib's development files, which LCM's headers do not need
kadr_library(lcm lcm/lcm-cpp.hpp lcm PACKAGE liblcm-dev PURPOSE kadr)
kadr_library(xxhash xxhash.h xxhash PACKAGE libxxhash-dev PURPOSE kadr)
find_program(LCM_GEN lcm-gen)
if(NOT LCM_GEN)
  kadr_missing(lcm-gen liblcm-bin kadr)
endif()

# pagmo by file as well: its package file looks for all of Boost and TBB, and only Boost's serialization is linked
if((KADR_TESTS OR KADR_BENCH) AND NOT KADR_GENETIC STREQUAL "OFF")
  set(kind OPTIONAL)
  if(NOT KADR_GENETIC STREQUAL "AUTO")
    set(kind)
  endif()
  kadr_library(pagmo pagmo/algorithm.hpp pagmo boost_serialization ${kind}
    PACKAGE libpagmo-dev PURPOSE "the genetic search (KADR_GENETIC)")
  if(NOT TARGET external::pagmo)
    message(STATUS "kadr: without the genetic search in tests and benchmarks: install the Debian package libpagmo-dev")
  endif()
endif()
