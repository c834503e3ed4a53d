# Makes report_template.cpp: the bundled page, or an empty one with KADR_WEB=OFF. Packages come from npm by the lock file
# into the build folder; nothing of them is in the repository.
set(report_template ${PROJECT_BINARY_DIR}/generated/report_template.cpp)
if(NOT KADR_WEB OR NOT KADR_CLI)
  file(CONFIGURE OUTPUT ${report_template} CONTENT [[
// Generated: built with KADR_WEB=OFF.
#include "emulator/log_tools/report/report_page.h"

std::string_view kadr::emulator::report_template() { return {}; }
]])
  return()
endif()

find_program(NODE node)
find_program(NPM npm)
if(NOT NODE OR NOT NPM)
  message(FATAL_ERROR "the report page needs nodejs and npm; -DKADR_WEB=OFF builds kadr without it")
endif()
set(web ${CMAKE_CURRENT_SOURCE_DIR}/pages/report)
set(work ${PROJECT_BINARY_DIR}/pages/report)
file(GLOB web_sources CONFIGURE_DEPENDS ${web}/src/*)
add_custom_command(OUTPUT ${work}/packages
  COMMAND ${CMAKE_COMMAND} -E make_directory ${work}
  COMMAND ${CMAKE_COMMAND} -E copy ${web}/package.json ${web}/package-lock.json ${work}
  COMMAND ${CMAKE_COMMAND} -E chdir ${work} ${NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error
  COMMAND ${CMAKE_COMMAND} -E touch ${work}/packages
  DEPENDS ${web}/package.json ${web}/package-lock.json
  COMMENT "npm packages of the report page" VERBATIM)
add_custom_command(OUTPUT ${report_template}
  COMMAND ${CMAKE_COMMAND} -E copy ${web}/tsconfig.json ${web}/build.mjs ${work}
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${work}/src
  COMMAND ${CMAKE_COMMAND} -E copy_directory ${web}/src ${work}/src
  COMMAND ${NODE} ${work}/node_modules/typescript/bin/tsc --noEmit -p ${work}
  COMMAND ${NODE} ${work}/build.mjs ${work}/template.html ${report_template}
  DEPENDS ${work}/packages ${web}/tsconfig.json ${web}/build.mjs ${web_sources}
  COMMENT "report page" VERBATIM)
