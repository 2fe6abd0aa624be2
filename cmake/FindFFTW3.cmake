# FindFFTW3: fast Fourier transforms in double precision.
# Defines FFTW3_FOUND, FFTW3_VERSION and the target FFTW3::FFTW3. Set FFTW3_ROOT to look elsewhere first.
find_path(FFTW3_INCLUDE_DIR fftw3.h)
find_library(FFTW3_LIBRARY fftw3)

if(FFTW3_LIBRARY AND NOT FFTW3_VERSION)  # the header does not tell; the library does: "fftw-3.3.10-..."
  file(STRINGS "${FFTW3_LIBRARY}" _fftw3_version REGEX "fftw-[0-9]+\\.[0-9]+" LIMIT_COUNT 1)
  if(_fftw3_version MATCHES "fftw-([0-9]+\\.[0-9]+(\\.[0-9]+)?)")
    set(FFTW3_VERSION "${CMAKE_MATCH_1}")
  endif()
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(FFTW3 REQUIRED_VARS FFTW3_LIBRARY FFTW3_INCLUDE_DIR VERSION_VAR FFTW3_VERSION)
mark_as_advanced(FFTW3_INCLUDE_DIR FFTW3_LIBRARY)

if(FFTW3_FOUND AND NOT TARGET FFTW3::FFTW3)
  add_library(FFTW3::FFTW3 UNKNOWN IMPORTED)
  set_target_properties(FFTW3::FFTW3 PROPERTIES IMPORTED_LOCATION "${FFTW3_LIBRARY}"
                                                INTERFACE_INCLUDE_DIRECTORIES "${FFTW3_INCLUDE_DIR}")
endif()
