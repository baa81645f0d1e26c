#pragma once

#include <string_view>

namespace skyhalo {

/// The text of `web/report.html`, built into the library so that one binary is enough. The data
/// goes where `/*SKYHALO_DATA*/null` stands.
extern const std::string_view kReportTemplate;

}  // namespace skyhalo
