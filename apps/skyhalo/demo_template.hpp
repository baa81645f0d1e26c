#pragma once

#include <string_view>

namespace skyhalo {

/// The text of `web/demo.html`, built into the program. The page's content goes where
/// `<!--SKYHALO_CONTENT-->` stands.
extern const std::string_view kDemoTemplate;

}  // namespace skyhalo
