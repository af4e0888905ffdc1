# After configuration, writes <build>/targets.json: each target of the project with its sources and its links.
# The scripts in scripts/ read it and keep no lists of their own.
#   [{"name": "duet_motion", "type": "STATIC_LIBRARY", "sources": ["model/motion/resample.cc", ...],
#     "public": ["absl::status", ...], "private": []}, ...]
# Sources are relative to the top folder; duet:: aliases are resolved.

# Sets OUT to every target made in FOLDER and below.
function(duet_targets_below folder out)
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  get_property(subfolders DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(subfolder IN LISTS subfolders)
    duet_targets_below(${subfolder} below)
    list(APPEND targets ${below})
  endforeach()
  set(${out} ${targets} PARENT_SCOPE)
endfunction()

# Sets OUT to a JSON array of the strings that follow.
function(duet_json_array out)
  list(TRANSFORM ARGN REPLACE "(.+)" "\"\\1\"")
  list(JOIN ARGN ", " joined)
  set(${out} "[${joined}]" PARENT_SCOPE)
endfunction()

# Sets OUT to the sources of TARGET, relative to the top folder.
function(duet_sources_of target out)
  get_target_property(folder ${target} SOURCE_DIR)
  get_target_property(sources ${target} SOURCES)
  set(paths "")
  foreach(source IN LISTS sources)
    if(source AND NOT source MATCHES "^\\$<")
      cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${folder} NORMALIZE)
      cmake_path(RELATIVE_PATH source BASE_DIRECTORY ${PROJECT_SOURCE_DIR})
      list(APPEND paths ${source})
    endif()
  endforeach()
  set(${out} ${paths} PARENT_SCOPE)
endfunction()

# Sets OUT to the links in PROPERTY of TARGET, without those that only the linker gets.
function(duet_links_of target property out)
  get_target_property(items ${target} ${property})
  set(links "")
  foreach(item IN LISTS items)
    if(item AND NOT item MATCHES "LINK_ONLY|^::@")
      if(TARGET ${item})
        get_target_property(real ${item} ALIASED_TARGET)
        if(real AND real MATCHES "^duet")
          set(item ${real})
        endif()
      endif()
      list(APPEND links ${item})
    endif()
  endforeach()
  set(${out} ${links} PARENT_SCOPE)
endfunction()

function(duet_write_target_table)
  duet_targets_below(${PROJECT_SOURCE_DIR} targets)
  set(rows "")
  foreach(target IN LISTS targets)
    get_target_property(type ${target} TYPE)
    duet_sources_of(${target} sources)
    duet_links_of(${target} INTERFACE_LINK_LIBRARIES public)
    duet_links_of(${target} LINK_LIBRARIES private)
    list(REMOVE_ITEM private ${public})
    foreach(list sources public private)
      duet_json_array(${list} ${${list}})
    endforeach()
    list(APPEND rows "{\"name\": \"${target}\", \"type\": \"${type}\", \"sources\": ${sources}, \"public\": ${public}, \"private\": ${private}}")
  endforeach()
  list(JOIN rows ",\n " rows)
  file(WRITE ${PROJECT_BINARY_DIR}/targets.json "[${rows}]\n")
endfunction()

cmake_language(DEFER DIRECTORY ${PROJECT_SOURCE_DIR} CALL duet_write_target_table)
