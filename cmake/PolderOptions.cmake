# Build options and the two helpers every module uses.
option(POLDER_BENCHMARKS "build the kernel benchmarks" ON)
set(POLDER_SIMD "dispatch" CACHE STRING
    "vector code of the hot kernels: 'dispatch' builds every level and picks one when the program starts; \
'native' builds the whole program for this machine only")
set_property(CACHE POLDER_SIMD PROPERTY STRINGS dispatch native)
option(POLDER_SANITIZE "address and undefined-behaviour sanitizers" OFF)

add_library(polder_flags INTERFACE)
target_compile_options(polder_flags INTERFACE -Wall -Wextra -fno-math-errno -fno-trapping-math)
if(POLDER_SIMD STREQUAL "native")
  target_compile_options(polder_flags INTERFACE -march=native)
endif()
if(POLDER_SIMD STREQUAL "native" OR NOT CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(POLDER_SIMD_LEVELS native)
  target_compile_definitions(polder_flags INTERFACE POLDER_SIMD_NATIVE)
else()
  set(POLDER_SIMD_LEVELS baseline avx2 avx512)
endif()
if(POLDER_SANITIZE)
  target_compile_options(polder_flags INTERFACE -fsanitize=address,undefined -fno-omit-frame-pointer
                                                -fno-sanitize-recover=undefined)
  target_link_options(polder_flags INTERFACE -fsanitize=address,undefined)
endif()

# polder_module(NAME SOURCES ... [LINK ...] [PRIVATE_LINK ...]): one layer of the house as a library target polder::NAME.
function(polder_module name)
  cmake_parse_arguments(M "" "" "SOURCES;LINK;PRIVATE_LINK" ${ARGN})
  add_library(polder_${name} STATIC ${M_SOURCES})
  add_library(polder::${name} ALIAS polder_${name})
  set_target_properties(polder_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(polder_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                                                   $<INSTALL_INTERFACE:include/polder>)
  target_compile_features(polder_${name} PUBLIC cxx_std_20)
  target_link_libraries(polder_${name} PUBLIC ${M_LINK} PRIVATE $<BUILD_INTERFACE:polder_flags> ${M_PRIVATE_LINK})
endfunction()

# polder_kernels(NAME SOURCES ...): sources compiled once for each vector level, each in a namespace of its own
# (core/simd.hpp), so that one program carries all of them and picks one when it starts (core/simd_level.hpp).
function(polder_kernels name)
  cmake_parse_arguments(K "" "" "SOURCES" ${ARGN})
  set(flags_native "")
  set(flags_baseline "")
  set(flags_avx2 -march=x86-64-v3)
  set(flags_avx512 -march=x86-64-v4 -mprefer-vector-width=512)
  foreach(level ${POLDER_SIMD_LEVELS})
    set(object polder_${name}_${level})
    add_library(${object} OBJECT ${K_SOURCES})
    target_include_directories(${object} PRIVATE ${PROJECT_SOURCE_DIR})
    target_compile_definitions(${object} PRIVATE POLDER_SIMD_NAMESPACE=simd_${level})
    target_compile_options(${object} PRIVATE -Wno-psabi $<$<CONFIG:Release>:-O3> ${flags_${level}})
    target_link_libraries(${object} PRIVATE polder_flags OpenMP::OpenMP_CXX)
    target_sources(polder_${name} PRIVATE $<TARGET_OBJECTS:${object}>)
  endforeach()
endfunction()
