# drape_module(NAME [QUICK] SOURCES a.cpp ... [DEPENDS modules ...] [PUBLIC targets ...] [PRIVATE targets ...])
#
# One static library per module, `drape_NAME`, with an include root of its own (include/drape/NAME), so that
# a header of a module that is not named in DEPENDS cannot be found. DEPENDS are drape modules whose headers
# the module's own headers use; PUBLIC are libraries seen in its headers (Eigen); PRIVATE stay inside src/. QUICK
# is for code that handles text and files: it is optimised less, and compiles in two thirds of the time.
add_library(drape_flags INTERFACE)
target_compile_options(drape_flags INTERFACE
  -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion
  # {.name = "x"} says all that it needs to.
  -Wno-missing-field-initializers
  # The same bytes on every machine of one architecture: no fused multiply-add behind our back.
  -ffp-contract=off)
if(DRAPE_WARNINGS_AS_ERRORS)
  target_compile_options(drape_flags INTERFACE -Werror)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # g++ 12 reports these inside Eigen and std::string code that is right (GCC bugs 105329, 106199).
  target_compile_options(drape_flags INTERFACE -Wno-maybe-uninitialized -Wno-restrict -Wno-array-bounds
                                               -Wno-stringop-overflow)
endif()

# The later -O counts.
function(drape_compile_quickly target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

function(drape_module name)
  cmake_parse_arguments(arg "QUICK" "" "SOURCES;DEPENDS;PUBLIC;PRIVATE" ${ARGN})
  set(target drape_${name})
  add_library(${target} STATIC ${arg_SOURCES})
  target_include_directories(${target} PUBLIC ${CMAKE_CURRENT_SOURCE_DIR}/include
                                       PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src)
  target_link_libraries(${target} PUBLIC ${arg_PUBLIC} PRIVATE drape_flags ${arg_PRIVATE})
  if(arg_QUICK)
    drape_compile_quickly(${target})
  endif()
  foreach(module ${arg_DEPENDS})
    target_link_libraries(${target} PUBLIC drape_${module})
  endforeach()
endfunction()
