# FindCHOLMOD: SuiteSparse's sparse Cholesky factorisation and the ordering libraries it needs.
# Defines CHOLMOD_FOUND, CHOLMOD_VERSION and the target CHOLMOD::CHOLMOD. Set CHOLMOD_ROOT to look elsewhere first.
find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse)
find_library(CHOLMOD_LIBRARY cholmod)
set(_cholmod_parts "")
foreach(_part amd colamd camd ccolamd suitesparseconfig)
  find_library(CHOLMOD_${_part}_LIBRARY ${_part})
  list(APPEND _cholmod_parts CHOLMOD_${_part}_LIBRARY)
endforeach()

if(CHOLMOD_INCLUDE_DIR)
  file(STRINGS "${CHOLMOD_INCLUDE_DIR}/cholmod_core.h" _cholmod_lines
       REGEX "^#define CHOLMOD_(MAIN|SUB|SUBSUB)_VERSION [0-9]+")
  string(REGEX REPLACE "[^0-9;]*([0-9]+)" "\\1" CHOLMOD_VERSION "${_cholmod_lines}")
  list(JOIN CHOLMOD_VERSION "." CHOLMOD_VERSION)
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(CHOLMOD
  REQUIRED_VARS CHOLMOD_LIBRARY CHOLMOD_INCLUDE_DIR ${_cholmod_parts}
  VERSION_VAR CHOLMOD_VERSION)
mark_as_advanced(CHOLMOD_INCLUDE_DIR CHOLMOD_LIBRARY ${_cholmod_parts})

if(CHOLMOD_FOUND AND NOT TARGET CHOLMOD::CHOLMOD)
  add_library(CHOLMOD::CHOLMOD UNKNOWN IMPORTED)
  set(_cholmod_libraries "")
  foreach(_part IN LISTS _cholmod_parts)
    list(APPEND _cholmod_libraries "${${_part}}")
  endforeach()
  set_target_properties(CHOLMOD::CHOLMOD PROPERTIES
    IMPORTED_LOCATION "${CHOLMOD_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${CHOLMOD_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES "${_cholmod_libraries}")
endif()
