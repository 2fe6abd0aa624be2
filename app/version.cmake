# Writes OUTPUT from version.cpp.in with the commit of SOURCE, if that changed: a build after a commit recompiles one file.
execute_process(COMMAND git -C ${SOURCE} rev-parse --short=12 HEAD
                OUTPUT_VARIABLE COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(COMMIT "")
else()
  execute_process(COMMAND git -C ${SOURCE} diff --quiet HEAD ERROR_QUIET RESULT_VARIABLE changed)
  if(changed)
    string(APPEND COMMIT "+")
  endif()
endif()
configure_file(${SOURCE}/app/version.cpp.in ${OUTPUT} @ONLY)
