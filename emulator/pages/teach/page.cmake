# Makes teach_template.cpp: the bundled teaching page with its core, or an empty one with KADR_WEB=OFF. The core is kadr's own
# C++, compiled to WebAssembly without exceptions: neither LCM nor CVODE nor fmt reaches it.
set(teach_template ${PROJECT_BINARY_DIR}/generated/teach_template.cpp)
if(NOT KADR_WEB OR NOT KADR_CLI)
  file(CONFIGURE OUTPUT ${teach_template} CONTENT [[
// Generated: built with KADR_WEB=OFF.
#include "emulator/studies/teach/teach_page.h"

std::string_view kadr::emulator::teach_template() { return {}; }
]])
  return()
endif()

find_program(WASM_CXX NAMES clang++-14 clang++)
find_program(WASM_LD NAMES wasm-ld wasm-ld-14)
if(NOT WASM_CXX OR NOT WASM_LD OR NOT EXISTS /usr/include/wasm32-wasi)
  message(FATAL_ERROR "the teaching page needs clang, lld and the wasm32 packages that tools/packages lists under web; "
    "-DKADR_WEB=OFF builds kadr without it")
endif()
set(core_folder ${PROJECT_BINARY_DIR}/pages/core)
set(core ${core_folder}/core.wasm)
file(GLOB core_sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/interpolator/lattice/*.cpp)
list(APPEND core_sources ${CMAKE_CURRENT_SOURCE_DIR}/pages/teach/core.cpp)
foreach(name arc_length bezier_curve joint paper_table)
  list(APPEND core_sources ${PROJECT_SOURCE_DIR}/planner/bezier/${name}.cpp)
endforeach()
foreach(name case_words deviation follow picture pulse_timing sweep)
  list(APPEND core_sources ${CMAKE_CURRENT_SOURCE_DIR}/studies/teach/${name}.cpp)
endforeach()
set(core_objects)
foreach(source ${core_sources})
  file(RELATIVE_PATH name ${PROJECT_SOURCE_DIR} ${source})
  string(REPLACE "/" "_" name ${name})
  set(object ${core_folder}/${name}.o)
  list(APPEND core_objects ${object})
  add_custom_command(OUTPUT ${object}
    COMMAND ${WASM_CXX} --target=wasm32-wasi -std=c++20 -Os -fno-exceptions -fno-rtti -ffp-contract=off -fno-fast-math
      -Wall -Wextra -Wpedantic -Wshadow $<$<BOOL:${KADR_WERROR}>:-Werror> -I${PROJECT_SOURCE_DIR} -MD -MF ${object}.d -c ${source} -o ${object}
    DEPENDS ${source} DEPFILE ${object}.d COMMENT "WebAssembly: ${name}" COMMAND_EXPAND_LISTS VERBATIM)
endforeach()
file(MAKE_DIRECTORY ${core_folder})
add_custom_command(OUTPUT ${core}
  COMMAND ${WASM_CXX} --target=wasm32-wasi -mexec-model=reactor -Wl,--strip-all -Wl,--gc-sections ${core_objects} -o ${core}
  DEPENDS ${core_objects} COMMENT "core of the teaching page" VERBATIM)

# pages/report lies beside, as in the source tree: style, words and packages are shared
set(teach_web ${CMAKE_CURRENT_SOURCE_DIR}/pages/teach)
set(teach_work ${PROJECT_BINARY_DIR}/pages/teach)
file(GLOB teach_web_sources CONFIGURE_DEPENDS ${teach_web}/src/*)
add_custom_command(OUTPUT ${teach_template}
  COMMAND ${CMAKE_COMMAND} -E make_directory ${teach_work}
  COMMAND ${CMAKE_COMMAND} -E copy ${teach_web}/tsconfig.json ${teach_work}
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${teach_work}/src
  COMMAND ${CMAKE_COMMAND} -E copy_directory ${teach_web}/src ${teach_work}/src
  COMMAND ${NODE} ${work}/node_modules/typescript/bin/tsc --noEmit -p ${teach_work}
  COMMAND ${NODE} ${work}/build.mjs ${teach_work}/template.html ${teach_template} teach ${core}
  DEPENDS ${report_template} ${core} ${teach_web}/tsconfig.json ${teach_web_sources}
  COMMENT "teaching page" VERBATIM)
