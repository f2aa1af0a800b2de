// What all report pages share: head, cards, navigation, sections.
#pragma once

#include <string>
#include <vector>

namespace fovea::app {

/// A section of a page with its place in the navigation.
struct Part {
  std::string id, title, html;
};

/// Names and texts are plain; what is called html is markup already.
struct PageLayout {
  std::string map_name, drive_name, protocol, frames_text, explanation;
  std::string defined_in;  ///< the document that defines the figures
  std::vector<int> cameras;
  std::string hero_html, warnings_html, cards_html;
  std::vector<Part> parts;
};

/// The whole page.
std::string page_text(const PageLayout& layout);

/// One of the main figures: its name, its value, what belongs to it.
std::string card(const std::string& name, const std::string& value, const std::string& more);

/// Views (see view_panels) with the choice of what lies over the photograph.
std::string stage(const std::string& views_html);

/// A heading, a note (markup) and a chart in a box; empty for no chart.
std::string chart_panel(const std::string& title, const std::string& note_html,
                        const std::string& chart);

}  // namespace fovea::app
