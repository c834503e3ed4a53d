# cmake -D KADR=PROGRAM -D OUT=DIR -P shell_files.cmake: the manual page and the completions, by the program itself.
file(MAKE_DIRECTORY ${OUT})
function(written file)
  execute_process(COMMAND ${KADR} ${ARGN} OUTPUT_FILE ${OUT}/${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
written(kadr.1 man)
written(kadr.bash completion bash)
written(_kadr completion zsh)
written(kadr.fish completion fish)
