#pragma once
// Styles and script of the report, made part of the program from renderer/converge/page.

#include <string_view>

namespace tessera {

std::string_view plot_style();  // of a plot that is a file of its own
std::string_view page_style();  // of the page, plots in it included
std::string_view page_script();

}  // namespace tessera
