# Build options and the helpers every module uses.
include(GNUInstallDirs)

find_program(POLDER_CCACHE ccache)
if(POLDER_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${POLDER_CCACHE})
endif()

option(POLDER_BENCHMARKS "build the kernel benchmarks" ON)
set(POLDER_SIMD "dispatch" CACHE STRING
    "vector code of the hot kernels: 'dispatch' builds every level and picks one when the program starts; \
'native' builds the whole program for this machine only")
set_property(CACHE POLDER_SIMD PROPERTY STRINGS dispatch native)
option(POLDER_SANITIZE "address and undefined-behaviour sanitizers" OFF)

add_library(polder_flags INTERFACE)
target_compile_options(polder_flags INTERFACE -Wall -Wextra -fno-math-errno -fno-trapping-math)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(polder_flags INTERFACE -Wno-restrict)  # false alarm on "literal" + std::string, GCC bug 105651
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64"
   AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 12 AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 12.3)
  # Copied 32 bytes at a time, the constants {a, a, 0, 0} become {a, a, a, a}, GCC bug 108599. Copies of 16 bytes are
  # right; vector code is not touched by this. Test: "a list that ends in zeros".
  target_compile_options(polder_flags INTERFACE -mmove-max=128 -mstore-max=128)
endif()
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

# polder_find_package(PACKAGE ...): find_package(PACKAGE REQUIRED ...) that the installed package repeats, because a
# program that links Polder's static libraries needs what they need. For packages of Polder's libraries only; what just
# the program or the tests use is found with plain find_package.
set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL ON)
macro(polder_find_package)
  find_package(${ARGV} REQUIRED)
  string(REPLACE ";" " " polder_arguments "${ARGV}")
  set_property(GLOBAL APPEND_STRING PROPERTY POLDER_DEPENDENCIES "find_dependency(${polder_arguments})\n")
endmacro()

# polder_module(NAME SOURCES ... [LINK ...] [PRIVATE_LINK ...]): one layer of the house as a library target polder::NAME,
# installed as Polder::NAME with the headers of its folder.
function(polder_module name)
  cmake_parse_arguments(M "" "" "SOURCES;LINK;PRIVATE_LINK" ${ARGN})
  add_library(polder_${name} STATIC ${M_SOURCES})
  add_library(polder::${name} ALIAS polder_${name})
  set_target_properties(polder_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(polder_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                                                   $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/polder>)
  target_compile_features(polder_${name} PUBLIC cxx_std_20)
  target_link_libraries(polder_${name} PUBLIC ${M_LINK} PRIVATE $<BUILD_INTERFACE:polder_flags> ${M_PRIVATE_LINK})
  if(POLDER_SIMD_LEVELS STREQUAL "native")  # headers must name the same level in a program that uses the library
    target_compile_definitions(polder_${name} INTERFACE POLDER_SIMD_NATIVE)
  endif()
  if(POLDER_SANITIZE)  # a library with sanitizers links into a program with sanitizers only
    target_link_options(polder_${name} INTERFACE -fsanitize=address,undefined)
  endif()
  install(TARGETS polder_${name} EXPORT PolderTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/polder
          FILES_MATCHING PATTERN "*.hpp")
  set_property(GLOBAL APPEND PROPERTY POLDER_MODULES ${name})
endfunction()

# polder_kernels(NAME SOURCES ...): sources compiled once for each vector level, each in a namespace of its own
# (core/simd.hpp), so that one program carries all of them and picks one when it starts (core/simd_level.hpp).
#
# Inline functions of other headers (std::vector, say) are compiled into these objects too, with the level's
# instructions, and the linker keeps any one copy for the whole program: on an older processor perhaps an unusable one.
# So the objects of a level above the baseline are joined into one that exports only the names of its own namespace.
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
    target_link_libraries(${object} PRIVATE polder_flags)
    if(level MATCHES "^(native|baseline)$")
      target_sources(polder_${name} PRIVATE $<TARGET_OBJECTS:${object}>)
    else()
      target_compile_options(${object} PRIVATE -fno-gnu-unique)
      set(joined ${CMAKE_CURRENT_BINARY_DIR}/kernels_${level}.o)
      add_custom_command(
        OUTPUT ${joined}
        COMMAND ${CMAKE_LINKER} -r --force-group-allocation -o ${joined}.all $<TARGET_OBJECTS:${object}>
        COMMAND ${CMAKE_OBJCOPY} --wildcard --keep-global-symbol=*simd_${level}* ${joined}.all ${joined}
        COMMAND ${CMAKE_COMMAND} -E rm ${joined}.all
        DEPENDS ${object} $<TARGET_OBJECTS:${object}>
        COMMENT "Joining the ${level} kernels of ${name}"
        COMMAND_EXPAND_LISTS VERBATIM)
      set_source_files_properties(${joined} PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)
      target_sources(polder_${name} PRIVATE ${joined})
    endif()
  endforeach()
endfunction()
