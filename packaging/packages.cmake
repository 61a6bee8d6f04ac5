# SPDX-License-Identifier: Apache-2.0
# CPack's settings. The commit's part of the version is added when it runs (version.cmake).
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME skein)
set(CPACK_PACKAGE_VENDOR Skein)
set(CPACK_PACKAGE_CONTACT "The Skein developers <skein@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Cooperating teams of small unmanned aircraft")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL onboard ground bench doc)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS OFF)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
if(CMAKE_SYSTEM_PROCESSOR STREQUAL "aarch64")
  set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE arm64)
endif()

set(about_onboard "The process of one vehicle: joins the mission network, takes part in
coalitions and formations and flies the vehicle's flight controller. With a
systemd unit for each vehicle, skein-onboard@N.service, and examples for CAN
and batman-adv by systemd-networkd.")
set(about_ground "The ground station: shows the fleet and its mission in a browser, and is
where an operator authorises or refuses deliveries and gives a formation its
orders. With skein, which configures and starts a fleet, and skein-ros2, which
shows a team to ROS 2.")
set(about_bench "The bench: flies missions on one machine, with every process, a radio and its
faults, flight controllers on CAN, and in virtual time; judges them and
writes a report.")
set(about_doc "The documents: what Skein does, how it is configured and flown, and why it
is as it is.")

# The scripts of maintainers, with what they share.
file(READ debian/functions FUNCTIONS)
string(STRIP "${FUNCTIONS}" FUNCTIONS)
foreach(component onboard ground)
  set(scripts)
  foreach(script preinst prerm postinst postrm)
    if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/debian/${component}.${script})
      configure_file(debian/${component}.${script} control/${component}/${script} @ONLY)
      file(CHMOD ${CMAKE_CURRENT_BINARY_DIR}/control/${component}/${script}
        PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
      list(APPEND scripts ${CMAKE_CURRENT_BINARY_DIR}/control/${component}/${script})
    endif()
  endforeach()
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_CONTROL_EXTRA ${scripts})
endforeach()
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS debian/functions)

foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME skein-${component})
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${about_${component}}")
endforeach()
# procps: skein fleet status asks it when a program was started.
set(CPACK_DEBIAN_ONBOARD_PACKAGE_DEPENDS "systemd, procps")
set(CPACK_DEBIAN_ONBOARD_PACKAGE_RECOMMENDS "chrony | systemd-timesyncd")
set(CPACK_DEBIAN_ONBOARD_PACKAGE_SUGGESTS "skein-doc, can-utils, batctl, iw")
set(CPACK_DEBIAN_GROUND_PACKAGE_DEPENDS "systemd, procps")
set(CPACK_DEBIAN_GROUND_PACKAGE_RECOMMENDS "chrony | systemd-timesyncd")
set(CPACK_DEBIAN_GROUND_PACKAGE_SUGGESTS skein-doc)
set(CPACK_DEBIAN_BENCH_PACKAGE_DEPENDS "skein-onboard (= @version@), skein-ground (= @version@)")
set(CPACK_DEBIAN_BENCH_PACKAGE_SUGGESTS skein-doc)
set(CPACK_DEBIAN_DOC_PACKAGE_SECTION doc)
set(CPACK_DEBIAN_DOC_PACKAGE_ARCHITECTURE all)
set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_CURRENT_SOURCE_DIR}/version.cmake)
set(CPACK_SKEIN_SOURCE_DIR ${PROJECT_SOURCE_DIR})
set(CPACK_SKEIN_CROSS ${CMAKE_CROSSCOMPILING})
include(CPack)
