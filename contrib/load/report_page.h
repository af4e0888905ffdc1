#ifndef DUET_CONTRIB_LOAD_REPORT_PAGE_H_
#define DUET_CONTRIB_LOAD_REPORT_PAGE_H_

#include <string>

namespace duet::contrib::load {

// The HTML page that draws a report's JSON.
std::string PageOf(const std::string& json);

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_REPORT_PAGE_H_
