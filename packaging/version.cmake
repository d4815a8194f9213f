# SPDX-License-Identifier: Apache-2.0
# Version of the program and of its packages: that of project(), "+", and the number of commits since the one
# that set it. Tags do not count: a clone need not have them.
#   RPSUP_VERSION       0.1.0+12; 0.1.0 at the commit that set it, in an archive of the sources, in a shallow clone
#   RPSUP_VERSION_TEXT  0.1.0+12.g0123456789ab, with .dirty after it if tracked files are changed
#   RPSUP_COMMIT        0123456789ab, with -dirty after it likewise; unknown without Git

# Output of Git, empty if it fails: run_git(VARIABLE ARGUMENT...)
function(run_git variable)
  execute_process(COMMAND git ${ARGN} WORKING_DIRECTORY ${CMAKE_SOURCE_DIR}
                  OUTPUT_VARIABLE output OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    set(output "")
  endif()
  set(${variable} "${output}" PARENT_SCOPE)
endfunction()

block(PROPAGATE RPSUP_VERSION RPSUP_VERSION_TEXT RPSUP_COMMIT)
  set(count 0)
  string(REGEX MATCH "^[0-9a-f]+" RPSUP_COMMIT "$Format:%H$")  # git archive writes the commit here
  string(SUBSTRING "${RPSUP_COMMIT}" 0 12 RPSUP_COMMIT)
  if(EXISTS ${CMAKE_SOURCE_DIR}/.git)  # without it, Git would speak of a repository around the sources
    run_git(RPSUP_COMMIT describe --always --dirty --abbrev=12 "--exclude=*")
    run_git(is_shallow rev-parse --is-shallow-repository)
    if(is_shallow STREQUAL "false")
      run_git(release log -1 --format=%H "-Srpsup VERSION ${PROJECT_VERSION} " -- CMakeLists.txt)
      if(release)  # not yet, if the version is new and not committed
        run_git(count rev-list --count ${release}..HEAD)
      endif()
    else()
      message(WARNING "Git cannot count the commits of this clone, as it is shallow or not Git's to read: "
                      "the version is ${PROJECT_VERSION}, without their number")
    endif()
    # Every commit adds a line to this file, which configures again: the program names the right commit.
    run_git(head_log rev-parse --path-format=absolute --git-path logs/HEAD)
    if(head_log AND EXISTS ${head_log})
      set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${head_log})
    endif()
  endif()

  set(RPSUP_VERSION ${PROJECT_VERSION})
  if(count GREATER 0)
    string(APPEND RPSUP_VERSION "+${count}")
  endif()
  set(RPSUP_VERSION_TEXT ${RPSUP_VERSION})
  if(RPSUP_COMMIT)
    string(REPLACE "-dirty" ".dirty" commit ${RPSUP_COMMIT})
    if(count GREATER 0)
      string(APPEND RPSUP_VERSION_TEXT ".g${commit}")
    else()
      string(APPEND RPSUP_VERSION_TEXT "+g${commit}")
    endif()
  else()
    set(RPSUP_COMMIT unknown)
  endif()
endblock()
