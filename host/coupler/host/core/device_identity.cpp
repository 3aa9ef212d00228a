// SPDX-License-Identifier: Apache-2.0
// Device compares the device's map with its own, and decides what to do if they differ.
#include <utility>

#include <fmt/format.h>

#include "coupler/host/core/device.hpp"
#include "coupler/map/node_address.hpp"

namespace coupler::host {

Result<> Device::prove_equal() {
  if (answers_identity_ == false) return {};
  const std::uint64_t replies = link_.replies();
  const Result<Identity> identity = check_identity(link_, map_, load_);
  const bool may_ignore_it = only_looks_ && !answers_identity_ && link_.replies() == replies;
  if (!identity && may_ignore_it) return treat_as_foreign(identity.error());
  if (!identity) {
    explain_silence(identity.error());
    return tl::make_unexpected(identity.error());
  }
  explains_silence_ = false;
  answers_identity_ = true;
  Result<identity::Further> further;
  is_node_ = identity->verdict != Identity::Verdict::foreign;
  if (is_node_) further = read_further(link_);
  if (!further) return tl::make_unexpected(further.error());
  node_ = *further;
  peer_ = to_string(node_.machine);
  statistics_.identified(identity->verdict, further->machine);
  sink_.on_identified(identity->verdict);
  return judge(*identity);
}

/// Some couplers do not answer a request for addresses that they do not have. The connection is replaced,
/// so that a late answer is not taken for the answer to another request.
Result<> Device::treat_as_foreign(const Error& error) {
  sink_.on_note(Level::info, fmt::format("the device does not answer the request for its identity ({}): it "
                                         "is read as a foreign device, without comparing maps",
                                         to_string(error)));
  answers_identity_ = false;
  identity_suffices_ = false;
  return connect_only();
}

/// Takes effect in poller_.start().
void Device::leave_out(const Identity& identity) {
  for (const ForeignPoint& before : left_out_) values_.set_aside({&before.point, 1}, {});
  left_out_ = foreign_points(map_, identity);
  std::vector<std::uint32_t> points;
  for (const ForeignPoint& foreign : left_out_) {
    values_.set_aside({&foreign.point, 1}, foreign.why);
    points.push_back(foreign.point);
  }
  poller_.leave_out(std::move(points));
}

void Device::explain_silence(const Error& error) {
  const bool silent = (is_no_reply(error) || is_unit_away(error)) && !has_remedy(error);
  if (silent && std::exchange(explains_silence_, false))
    sink_.on_report(Level::warning, silence_text(map_, error));
}

Result<> Device::judge(const Identity& identity) {
  if (only_looks_) leave_out(identity);
  if (identity.verdict != Identity::Verdict::different) {
    reported_fingerprint_ = 0;
    if (identity.verdict == Identity::Verdict::superset) sink_.on_note(Level::info, superset_text);
    return {};
  }
  if (only_looks_) {
    std::string text = difference_text(map_, identity);
    if (!identity.points.empty())
      text += "\nOnly points that are the same are read. To read by the device's own map, give " +
              node_address_text(map_.connection) + " instead of this one";
    sink_.on_note(Level::warning, text);
    return {};
  }
  const bool refuse = verify_ == Verify::require;
  const Time now = clock_.now();
  // A device that shows another map at each connect is told once a minute.
  const bool is_due = !reported_difference_at_ || now - *reported_difference_at_ >= std::chrono::minutes(1);
  if (reported_fingerprint_ != identity.fingerprint && is_due) {
    reported_fingerprint_ = identity.fingerprint;
    reported_difference_at_ = now;
    std::string text = difference_text(map_, identity);
    if (refuse)
      text +=
          "\nNothing is read or written. Give both sides the same map, or accept it with --verify warn (a "
          "client: Options::verify)";
    sink_.on_report(refuse ? Level::error : Level::warning, text);
  }
  if (refuse) return fail(NotConnected{"the device has another map"});
  return {};
}

}  // namespace coupler::host
