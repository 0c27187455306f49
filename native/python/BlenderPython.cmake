# komorebi_find_blender_python(): asks Blender itself for the Python that it runs, since the first python3 on the
# PATH is often another one (pyenv, conda). Sets in the caller's scope
#   KOMOREBI_PYTHON_VERSION   for example 3.11
#   KOMOREBI_PYTHON_INCLUDE   the folder that holds its Python.h
#   KOMOREBI_PYTHON_SUFFIX    for example .cpython-311-x86_64-linux-gnu.so
# Blender is asked again only when the program that KOMOREBI_BLENDER names has changed.
function(komorebi_find_blender_python)
  find_program(blender NAMES ${KOMOREBI_BLENDER} NO_CACHE)
  if(NOT blender)
    message(FATAL_ERROR "Blender was not found as `${KOMOREBI_BLENDER}`: install it, or name it by "
                        "-DKOMOREBI_BLENDER=/path/to/blender.")
  endif()
  file(REAL_PATH ${blender} program)
  file(TIMESTAMP ${program} time)
  if(NOT KOMOREBI_BLENDER_ASKED STREQUAL "${program} ${time}")
    komorebi_ask_blender(${blender} answer)
    set(KOMOREBI_BLENDER_ANSWER "${answer}" CACHE INTERNAL "Blender's Python: version, headers, module suffix")
    set(KOMOREBI_BLENDER_ASKED "${program} ${time}" CACHE INTERNAL "The Blender that gave this answer")
  endif()
  list(GET KOMOREBI_BLENDER_ANSWER 0 version)
  list(GET KOMOREBI_BLENDER_ANSWER 1 include)
  list(GET KOMOREBI_BLENDER_ANSWER 2 suffix)

  # Blender's own builds carry no Python.h; the system's serves if it is of the same version.
  set(folders ${include} /usr/include/python${version} /usr/local/include/python${version})
  find_path(header_folder Python.h PATHS ${folders} NO_DEFAULT_PATH NO_CACHE)
  if(NOT header_folder)
    list(REMOVE_DUPLICATES folders)
    list(JOIN folders ", " folders)
    message(FATAL_ERROR "${blender} runs Python ${version}, but Python.h of that version is in none of ${folders}: "
                        "install python${version}-dev, or name another Blender by -DKOMOREBI_BLENDER=/path/to/blender.")
  endif()
  message(STATUS "Blender's Python: ${version} (${blender}), headers in ${header_folder}")
  set(KOMOREBI_PYTHON_VERSION ${version} PARENT_SCOPE)
  set(KOMOREBI_PYTHON_INCLUDE ${header_folder} PARENT_SCOPE)
  set(KOMOREBI_PYTHON_SUFFIX ${suffix} PARENT_SCOPE)
endfunction()

# komorebi_ask_blender(BLENDER RESULT): a list of version, include folder and module suffix.
function(komorebi_ask_blender blender result)
  string(CONCAT question "import sys, sysconfig as s; print('KOMOREBI', '%d.%d' % sys.version_info[:2], "
                         "s.get_path('include'), s.get_config_var('EXT_SUFFIX'), sep='|')")
  set(run_python -b --factory-startup --python-expr)
  cmake_path(GET blender FILENAME name)
  if(name MATCHES "^python[0-9.]*$")  # with the module bpy
    set(run_python -c)
  endif()
  # A python of pyenv's on the PATH makes Debian's Blender take that prefix for its own: hence the plain PATH.
  execute_process(
    COMMAND ${CMAKE_COMMAND} -E env --unset=PYTHONHOME --unset=PYTHONPATH PATH=/usr/bin:/bin
            ${blender} ${run_python} "${question}"
    OUTPUT_VARIABLE output ERROR_VARIABLE errors RESULT_VARIABLE code TIMEOUT 120)
  if(NOT output MATCHES "KOMOREBI\\|([^|\n]+)\\|([^|\n]+)\\|([^|\n]+)")
    message(FATAL_ERROR "${blender} did not say which Python it runs (exit ${code}): ${output}${errors}")
  endif()
  set(${result} "${CMAKE_MATCH_1};${CMAKE_MATCH_2};${CMAKE_MATCH_3}" PARENT_SCOPE)
endfunction()
