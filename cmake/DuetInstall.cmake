# Installs the files that no source folder installs, and defines the Debian packages: `cpack -G DEB` in a
# build folder. A component is a package.
#
#   client              duet             the client and its manual pages
#   client-development  libduet-dev      headers and libraries of the client
#   server              duet-server      the server, its unit, its configuration
#   training            duet-training    training and evaluation

# Relative to the prefix, which is /usr in packages. Debian's locations for systemd's files.
set(DUET_SYSTEMD_UNIT_DIR lib/systemd/system CACHE STRING "Folder of the service's unit")
set(DUET_SYSUSERS_DIR lib/sysusers.d CACHE STRING "Folder of the user that the service runs as")
mark_as_advanced(DUET_SYSTEMD_UNIT_DIR DUET_SYSUSERS_DIR)

set(deploy ${PROJECT_SOURCE_DIR}/deploy)
duet_manual_page(duet-server 8 server "synthesise the motion with which one character reacts to another, over gRPC")
duet_manual_page(duet-import 1 training "convert a folder of motion files of two people to a training set")
set(training_programs duet-import)
if(DUET_TRAINING)
  list(APPEND training_programs duet-train duet-eval)
  duet_manual_page(duet-train 1 training "train a generator on a folder of captures and write a checkpoint")
  duet_manual_page(duet-eval 1 training "evaluate trained models and baselines on captures")
endif()
install(FILES ${deploy}/systemd/duet-server.service DESTINATION ${DUET_SYSTEMD_UNIT_DIR}
  COMPONENT server)
install(FILES ${deploy}/systemd/duet-server.sysusers RENAME duet-server.conf
  DESTINATION ${DUET_SYSUSERS_DIR} COMPONENT server)
install(TARGETS ${training_programs}
  RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT training)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME duet)
set(CPACK_PACKAGE_CONTACT "Duet contributors <duet@duet.invalid>")
# Each package has a summary of its own: the first line of its description.
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_STRIP_FILES ON)
# Packing does not build, so that one package does not build all others.
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)

set(CPACK_COMPONENTS_ALL client client-development server training)
set(CPACK_COMPONENT_TRAINING_GROUP training)
set(CPACK_COMPONENT_CLIENT_GROUP client)
set(CPACK_COMPONENT_CLIENT-DEVELOPMENT_GROUP development)
set(CPACK_COMPONENT_SERVER_GROUP server)
set(CPACK_DEB_COMPONENT_INSTALL ON)

set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_CLIENT_PACKAGE_NAME duet)
set(CPACK_DEBIAN_CLIENT_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_CLIENT_DESCRIPTION "client of the Duet motion synthesis server
Requests the motion that reacts to another from a duet-server: one clip, or a
whole data set. Reads BVH, glTF, CSV, JSON and NPY, and writes these
and HTML pages with a viewer.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libduet-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libgrpc++-dev, libprotobuf-dev, libabsl-dev")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "client library of the Duet motion synthesis server
Headers, static libraries and a CMake package (find_package(duet)) for C++
programs that request motion from a duet-server.")

set(CPACK_DEBIAN_SERVER_PACKAGE_NAME duet-server)
set(CPACK_DEBIAN_SERVER_PACKAGE_SECTION net)
set(CPACK_DEBIAN_SERVER_PACKAGE_DEPENDS
  "systemd | systemd-standalone-sysusers | systemd-sysusers")
set(CPACK_DEBIAN_SERVER_PACKAGE_SUGGESTS "duet, haproxy | nginx")
set(CPACK_DEBIAN_SERVER_PACKAGE_CONTROL_EXTRA
  ${deploy}/debian/conffiles ${deploy}/debian/postinst ${deploy}/debian/prerm
  ${deploy}/debian/postrm)
set(CPACK_DEBIAN_SERVER_DESCRIPTION "motion synthesis server, over gRPC
Synthesises the motion with which one character reacts to another, controlled
by weights for classes of interaction. Serves its embedded models or a folder
of models, as a service that systemd starts, watches and drains.")

set(CPACK_DEBIAN_TRAINING_PACKAGE_NAME duet-training)
set(CPACK_DEBIAN_TRAINING_PACKAGE_SECTION science)
set(CPACK_DEBIAN_TRAINING_PACKAGE_DEPENDS "libopenblas0-openmp")
set(CPACK_DEBIAN_TRAINING_PACKAGE_RECOMMENDS "python3, python3-matplotlib, python3-sklearn")
set(CPACK_DEBIAN_TRAINING_DESCRIPTION "training and evaluation of Duet's networks
Imports pairs of motions, trains the networks that duet-server serves, and
evaluates them.")

# Finishes each package's folder: Debian's documents, compressed pages.
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/DuetFinishPackage.cmake)
set(CPACK_DUET_DEPLOY ${deploy})
include(CPack)
