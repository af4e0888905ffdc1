#ifndef DUET_CLIENT_VIEWER_PAGE_DATA_H_
#define DUET_CLIENT_VIEWER_PAGE_DATA_H_

#include <string>

#include "client/viewer/page.h"

namespace duet::client::viewer {

// Returns the page's data as JSON that is safe inside <script> for any names:
//   {title, subtitle, joints [J], bones [[parent, child]], frameRate, frames, classes [C],
//    keyframes [{frame, weights [C]}], leader, follower, glb?, beat? {bpm, offset},
//    grade? {twisted, skating, leaderSkating, overlapping, badRuns [[first frame, frames]]}}
// with positions [frames, J, 3] as base64 of little-endian float32, and the time `offset` of the
// first beat in seconds.
std::string PageDataJson(const PageContent& content);

}  // namespace duet::client::viewer

#endif  // DUET_CLIENT_VIEWER_PAGE_DATA_H_
