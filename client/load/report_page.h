#ifndef DUET_CLIENT_LOAD_REPORT_PAGE_H_
#define DUET_CLIENT_LOAD_REPORT_PAGE_H_

#include <string>

namespace duet::client::load {

// The HTML page that draws a report's JSON.
std::string PageOf(const std::string& json);

}  // namespace duet::client::load

#endif  // DUET_CLIENT_LOAD_REPORT_PAGE_H_
