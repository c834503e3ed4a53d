# cmake --install BUILD [--prefix DIR]: the program, its manual page and completions, documents, machine files, scenarios
# and LCM types; nothing of another project. docs/install.md has the list.
include(GNUInstallDirs)
set(data ${CMAKE_INSTALL_DATADIR}/kadr)
install(TARGETS kadr RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})

foreach(paper README.md LICENSE CHANGELOG.md CONTRIBUTING.md SECURITY.md CITATION.cff)
  if(EXISTS ${PROJECT_SOURCE_DIR}/${paper})
    install(FILES ${paper} DESTINATION ${CMAKE_INSTALL_DOCDIR})
  endif()
endforeach()
# the examples that documents name are next to them
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} FILES_MATCHING
  PATTERN *.md PATTERN *.toml PATTERN *.csv PATTERN *.ngc PATTERN *.png PATTERN *.svg)

install(DIRECTORY machine/files/ DESTINATION ${data}/machines FILES_MATCHING PATTERN *.toml)
install(DIRECTORY scenarios DESTINATION ${data} FILES_MATCHING PATTERN *.toml PATTERN *.ngc PATTERN *.tbl PATTERN README.md
  PATTERN *.csv PATTERN *.awk PATTERN generator EXCLUDE)
install(FILES emulator/log/kadr.lcm DESTINATION ${data})
# documents name scenarios as they lie in the tree
file(RELATIVE_PATH scenarios_from_doc "/p/${CMAKE_INSTALL_DOCDIR}" "/p/${data}/scenarios")
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/generated/doc)
file(CREATE_LINK ${scenarios_from_doc} ${PROJECT_BINARY_DIR}/generated/doc/scenarios SYMBOLIC)
install(FILES ${PROJECT_BINARY_DIR}/generated/doc/scenarios DESTINATION ${CMAKE_INSTALL_DOCDIR})

# made by the program itself, so only where it can be run
if(NOT CMAKE_CROSSCOMPILING OR CMAKE_CROSSCOMPILING_EMULATOR)
  set(shell_files ${PROJECT_BINARY_DIR}/generated/shell)
  install(FILES ${shell_files}/kadr.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
  install(FILES ${shell_files}/kadr.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME kadr)
  install(FILES ${shell_files}/_kadr DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
  install(FILES ${shell_files}/kadr.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
else()
  message(STATUS "cross-compiling: no manual page and completions are installed, because kadr can't be run here")
endif()
