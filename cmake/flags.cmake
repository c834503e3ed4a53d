# Flags that every target gets. The floating-point ones are part of the determinism contract (docs/pipeline.md):
# no contraction to FMA, no value-changing optimisation; sqrt may be inlined since no code here reads errno or traps.
add_library(kadr_flags INTERFACE)
target_include_directories(kadr_flags INTERFACE ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/generated)
# Conversions that may lose a value are explicit; those of sign alone (array indices) are not asked for.
target_compile_options(kadr_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
  -Wconversion -Wno-sign-conversion $<$<BOOL:${KADR_WERROR}>:-Werror>
  -ffp-contract=off -fno-fast-math -fno-math-errno -fno-trapping-math)
target_compile_definitions(kadr_flags INTERFACE EIGEN_DONT_VECTORIZE EIGEN_MPL2_ONLY
  KADR_VERSION="${PROJECT_VERSION}")
# a broken promise names its file as it lies in the tree, and builds in two folders are the same bytes
target_compile_options(kadr_flags INTERFACE -fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND KADR_OPTIMIZE MATCHES "O3")
  # GCC 12 at -O3 inlines std::string and fmt so deep that it reports overlaps, bounds and overflows that can't happen; a
  # precompiled header takes away that these are the library's. The sanitizers see what is real.
  target_compile_options(kadr_flags INTERFACE -Wno-restrict -Wno-stringop-overflow -Wno-array-bounds -Wno-stringop-overread)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_FLAGS MATCHES "fsanitize=thread")
  # with calls of the sanitizer between them, GCC loses sight of what decides whether an optional has a value
  target_compile_options(kadr_flags INTERFACE -Wno-maybe-uninitialized)
endif()
if(KADR_FUZZ)
  target_compile_options(kadr_flags INTERFACE -fsanitize=float-cast-overflow)
  target_link_options(kadr_flags INTERFACE -fsanitize=float-cast-overflow)
endif()
if(KADR_SANITIZE OR KADR_FUZZ)
  target_compile_options(kadr_flags INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(kadr_flags INTERFACE -fsanitize=address,undefined)
endif()

# the tables of called functions are filled in before main() and read-only from then on
target_link_options(kadr_flags INTERFACE -Wl,-z,relro,-z,now)
# What a fault of ours meets before it does harm. A target that is compiled without optimisation can't have fortified calls:
# it sets its property KADR_UNOPTIMIZED.
if(KADR_HARDEN AND NOT KADR_SANITIZE AND NOT KADR_FUZZ AND NOT CMAKE_CXX_FLAGS MATCHES "fsanitize")
  target_compile_options(kadr_flags INTERFACE -fstack-protector-strong)
  target_compile_definitions(kadr_flags INTERFACE _GLIBCXX_ASSERTIONS)
  if(NOT KADR_OPTIMIZE MATCHES "-O0")
    target_compile_options(kadr_flags INTERFACE
      $<$<NOT:$<BOOL:$<TARGET_PROPERTY:KADR_UNOPTIMIZED>>>:-U_FORTIFY_SOURCE$<SEMICOLON>-D_FORTIFY_SOURCE=2>)
  endif()
endif()

# A precompiled header is known to ccache by its content alone, with these allowances
find_program(CCACHE ccache)
if(KADR_CCACHE AND CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER env
    CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime ${CCACHE})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(kadr_flags INTERFACE -fpch-preprocess)
  endif()
endif()

# kadr_batches(TARGET MOST): compiles the sources of one folder together, at most MOST at a time: a build reads headers
# a tenth as often. Names of a file's own (anonymous namespaces) differ from those of its neighbours. For work on
# single files -DKADR_BATCHES=OFF; the matrix builds do without, so that every file compiles on its own.
function(kadr_batches target most)
  if(NOT KADR_BATCHES)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    get_filename_component(folder ${source} DIRECTORY)
    get_source_file_property(apart ${source} SKIP_PRECOMPILE_HEADERS)
    get_source_file_property(alone ${source} SKIP_UNITY_BUILD_INCLUSION)
    if(NOT source MATCHES "\\.cpp$" OR apart OR alone)
      continue()
    endif()
    string(MAKE_C_IDENTIFIER "${folder}" key)
    math(EXPR batch "${count_${key}} + 0")
    math(EXPR count_${key} "${batch} + 1")
    math(EXPR batch "${batch} / ${most}")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP "${key}_${batch}")
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # a file's own types in its own Impl: one file includes it, the batch
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
  endif()
endfunction()

# headers of the standard library and of outside libraries that half of a build would be spent reading; the matrix builds
# do without, so that every file includes what it uses
set(kadr_precompiled <fmt/format.h> <algorithm> <array> <cmath> <functional> <map> <memory> <optional> <string>
  <tl/expected.hpp> <vector>)

# a switch names every enumerator: a new one is then missed nowhere. `default` is for enumerations of outside libraries
set(kadr_product_warnings -Wswitch-enum)

# kadr_folder(NAME DEPENDS ... [PRECOMPILE HEADER ...]): the static library of one folder.
function(kadr_folder name)
  cmake_parse_arguments(ARG "" "" "DEPENDS;PRECOMPILE" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  add_library(kadr_${name} STATIC ${sources})
  target_link_libraries(kadr_${name} PUBLIC kadr_flags ${ARG_DEPENDS})
  target_compile_options(kadr_${name} PRIVATE ${kadr_product_warnings})
  kadr_batches(kadr_${name} 8)
  target_precompile_headers(kadr_${name} PRIVATE ${kadr_precompiled} ${ARG_PRECOMPILE})
endfunction()

# kadr_room(NAME FOLDER DEPENDS ... [PRIVATE ...] [SOURCES ...]): the static library of a room, a folder below this one,
# or of the door above them, the files of this folder itself (FOLDER "").
#   PRIVATE  libraries that only its .cpp files see     SOURCES  besides the folder's own: generated ones
# All rooms use one precompiled header.
function(kadr_room name folder)
  cmake_parse_arguments(ARG "" "" "DEPENDS;PRIVATE;SOURCES" ${ARGN})
  if(folder)
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*.cpp)
  else()
    file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  endif()
  add_library(kadr_${name} STATIC ${sources} ${ARG_SOURCES})
  target_link_libraries(kadr_${name} PUBLIC kadr_flags ${ARG_DEPENDS} PRIVATE ${ARG_PRIVATE})
  target_compile_options(kadr_${name} PRIVATE ${kadr_product_warnings})
  kadr_batches(kadr_${name} 8)
  if(NOT TARGET kadr_headers)
    set(empty ${PROJECT_BINARY_DIR}/generated/headers.cpp)
    file(CONFIGURE OUTPUT ${empty} CONTENT "// Generated: holds the precompiled header of kadr's rooms.\n")
    add_library(kadr_headers OBJECT ${empty})
    target_link_libraries(kadr_headers PRIVATE kadr_flags fmt::fmt tl::expected nlohmann_json::nlohmann_json)
    target_precompile_headers(kadr_headers PRIVATE ${kadr_precompiled} <nlohmann/json.hpp>)
  endif()
  target_precompile_headers(kadr_${name} REUSE_FROM kadr_headers)
endfunction()
