# ctest -R lanes_.*_symbols: a file that is compiled for the instructions of some processors only defines no inline function
# that others have, too. The linker keeps one copy of such a function for all, which might be the one that other
# processors cannot run.
execute_process(COMMAND ${NM} --demangle ${OBJECT} OUTPUT_VARIABLE symbols RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "${NM} cannot read ${OBJECT}")
endif()
string(REGEX MATCHALL "[^\n]* [WVu] [^\n]*" shared "${symbols}")
if(NOT symbols MATCHES "follow_in_[48]_lanes")
  message(FATAL_ERROR "${OBJECT} is not the engine in lanes")
endif()
foreach(symbol IN LISTS shared)
  if(NOT symbol MATCHES "Engine<|Lanes<")
    message(SEND_ERROR "of the engine in lanes and of others: ${symbol}")
  endif()
endforeach()
