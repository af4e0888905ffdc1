# CPack runs this on the folder of files to pack, with one folder for each component group below it. Adds
# changelog, copyright, lintian's exceptions, and the server's README and configuration, and compresses as Debian requires.
set(names_client duet)
set(names_development libduet-dev)
set(names_server duet-server)
set(names_training duet-training)

# Compresses without name and time, so that the same files give the same package.
function(compress file)
  execute_process(COMMAND gzip -9 --no-name --force ${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(GLOB groups LIST_DIRECTORIES true ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/*)
foreach(folder IN LISTS groups)
  cmake_path(GET folder FILENAME group)
  if(NOT names_${group})
    continue()
  endif()
  set(documents ${folder}/usr/share/doc/${names_${group}})
  configure_file(${CPACK_DUET_DEPLOY}/debian/changelog ${documents}/changelog.Debian COPYONLY)
  compress(${documents}/changelog.Debian)
  configure_file(${CPACK_DUET_DEPLOY}/debian/copyright ${documents}/copyright COPYONLY)
  configure_file(${CPACK_DUET_DEPLOY}/../NOTICE ${documents}/NOTICE COPYONLY)
  configure_file(${CPACK_DUET_DEPLOY}/debian/lintian-overrides
    ${folder}/usr/share/lintian/overrides/${names_${group}} COPYONLY)
  if(group STREQUAL server)
    configure_file(${CPACK_DUET_DEPLOY}/README.md ${documents}/README.md COPYONLY)
    compress(${documents}/README.md)
    configure_file(${CPACK_DUET_DEPLOY}/debian/server.textproto ${folder}/etc/duet/server.textproto
      COPYONLY)
  endif()
  file(GLOB pages ${folder}/usr/share/man/man*/*.[1-9])
  foreach(page IN LISTS pages)
    compress(${page})
  endforeach()
endforeach()
