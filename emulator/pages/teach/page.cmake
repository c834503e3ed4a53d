# Makes teach_template.cpp: the bundled teaching page with its core, or an empty one where cmake/pages.cmake leaves it out. The
# core is kadr's own C++, compiled to WebAssembly without exceptions: neither LCM nor CVODE nor fmt reaches it.
set(teach_template ${PROJECT_BINARY_DIR}/generated/teach_template.cpp)
if(teach_page_missing)
  set(teach_template ${PROJECT_BINARY_DIR}/generated/no_teach_template.cpp)
  file(CONFIGURE OUTPUT ${teach_template} CONTENT [[
// Generated: built without the page.
#include "emulator/studies/teach/teach_page.h"

std::string_view kadr::studies::teach_template() { return {}; }
]])
  return()
endif()

set(core ${wasm_folder}/core.wasm)
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
  set(object ${wasm_folder}/${name}.o)
  list(APPEND core_objects ${object})
  add_custom_command(OUTPUT ${object}
    COMMAND ${WASM_CXX} ${kadr_wasm_flags} -Wall -Wextra -Wpedantic -Wshadow
      $<$<BOOL:${KADR_WERROR}>:-Werror> -I${PROJECT_SOURCE_DIR} -MD -MF ${object}.d -c ${source} -o ${object}
    DEPENDS ${source} DEPFILE ${object}.d COMMENT "WebAssembly: ${name}" COMMAND_EXPAND_LISTS VERBATIM)
endforeach()
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
  COMMAND ${NODE} ${report_web}/node_modules/typescript/bin/tsc --noEmit -p ${teach_work}
  COMMAND ${NODE} ${report_web}/build.mjs ${teach_work}/template.html ${teach_template} teach ${core}
  DEPENDS ${report_template} ${core} ${teach_web}/tsconfig.json ${teach_web_sources}
  COMMENT "teaching page" VERBATIM)
