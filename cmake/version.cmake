# SPDX-License-Identifier: GPL-3.0-or-later
# The commit that `vernier --version` and `vernierd --version` print beside PROJECT_VERSION (CMakeLists.txt, its one place); "unknown" outside a checkout,
# unless -DVERNIER_COMMIT=… says which one the files are of.
if(NOT DEFINED CACHE{VERNIER_COMMIT})
  set(VERNIER_COMMIT unknown)
  find_package(Git QUIET)
  if(GIT_FOUND)
    execute_process(COMMAND ${GIT_EXECUTABLE} -C ${CMAKE_SOURCE_DIR} rev-parse --short=12 HEAD
      OUTPUT_VARIABLE git_commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE git_result)
    if(git_result EQUAL 0)
      set(VERNIER_COMMIT ${git_commit})
    endif()
  endif()
endif()
