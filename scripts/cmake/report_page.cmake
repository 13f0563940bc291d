# Styles and script of the report of 'tessera converge' become part of the program.
set(page_folder ${CMAKE_SOURCE_DIR}/renderer/converge/page)
foreach(part IN ITEMS plot.css report.css report.js)
  file(READ ${page_folder}/${part} text)
  string(REPLACE "." "_" name ${part})
  set(page_${name} "${text}")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${page_folder}/${part})
endforeach()
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/report_page.cpp CONTENT [[
#include "renderer/converge/page.h"

namespace tessera {

std::string_view plot_style() { return R"page(@page_plot_css@)page"; }
std::string_view page_style() { return R"page(@page_plot_css@@page_report_css@)page"; }
std::string_view page_script() { return R"page(@page_report_js@)page"; }

}  // namespace tessera
]] @ONLY)
