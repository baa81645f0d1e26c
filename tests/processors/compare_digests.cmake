# Runs the same program here and under an emulator; fails unless both print the same, and something.
execute_process(COMMAND ${NATIVE} OUTPUT_VARIABLE here ERROR_VARIABLE note COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${EMULATOR} ${PROGRAM} OUTPUT_VARIABLE there ERROR_VARIABLE note_there
                COMMAND_ERROR_IS_FATAL ANY)
message(STATUS "here: ${note}there: ${note_there}")
if(here STREQUAL "" OR NOT here STREQUAL there)
  message(FATAL_ERROR "not the same\nhere:\n${here}\nthere:\n${there}")
endif()
