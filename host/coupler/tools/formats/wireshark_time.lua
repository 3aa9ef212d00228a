-- Function codes 65 and 66: changes, and outputs at a time ------------------------------------------------------------

local wait_code, schedule_code = 65, 66
local time_tables = { "coils", "discrete_inputs", "holding_registers", "input_registers" }
local reasons = {
  "its client cancelled it", "another write to the same point", "the watchdog expired", "outputs went to their safe state",
  "the node read a new map, lost or found a chip, or ended", "its connection ended",
  "the output could not be driven, or does not take the value", "the watchdog keeps outputs safe",
}

-- Nanoseconds, 8 bytes, as seconds of the node's clock.
local function node_time(tvb, at)
  local digits = tostring(tvb(at, 8):uint64())
  digits = string.rep("0", 10 - #digits) .. digits
  return digits:sub(1, -10) .. "." .. digits:sub(-9) .. " s"
end

local function whole(tvb, at) return tostring(tvb(at, 8):uint64()) end

-- As request_of(): of these two function codes, in their version 1.
local function time_request_of(tvb)
  local code, size = tvb(7, 1):uint(), tvb:len()
  if size < 16 or tvb(8, 1):uint() ~= 1 then return { code = code } end
  if code == wait_code and size == 23 then return { code = code, show = "waits for changes" } end
  if code ~= schedule_code then return { code = code } end
  local action = tvb(9, 1):uint()
  if action == 2 then return { code = code, show = "cancels a scheduled output" } end
  if action == 3 then
    local name = size >= 27 and time_tables[tvb(22, 1):uint()]
    if not name then return { code = code } end
    return { code = code, show = "cancels scheduled outputs",
             cancels = { table = name, start = tvb(23, 2):uint(), count = tvb(25, 2):uint() } }
  end
  if action ~= 1 then return { code = code } end
  local name = size > 32 and time_tables[tvb(26, 1):uint()]
  if not name then return { code = code } end
  return { code = code, show = "schedules", data = 32,
           write = { table = name, start = tvb(27, 2):uint(), count = tvb(29, 2):uint() } }
end

local function show_epoch(report, tvb, at)
  report:tell(fields.epoch, tvb(at, 4), tvb(at, 4):uint(), string.format("Epoch: 0x%08X", tvb(at, 4):uint()))
end

local function show_number(item, tvb, at) item:add(fields.number, tvb(at, 2)) end

local function show_cancelled_range(report, tvb, request)
  local range, from = request.cancels, "from " .. node_time(tvb, 14)
  report.item:add(tvb(14, 8), "Due: " .. from)
  report.item:add(tvb(22, 5), string.format("Addresses: %s %d, count %d", range.table, range.start, range.count))
  report:range("write", range, nil, from)
  if #report.names == 0 then report.pinfo.cols.info:append(" | " .. request.show) end
  report:close()
end

local function show_time_request(tvb, pinfo, tree, request)
  local report = new_report(tvb, pinfo, tree, request.show)
  if request.code == wait_code then
    report:tell(fields.longest_wait, tvb(9, 2), tvb(9, 2):uint(), string.format("Longest wait: %d ms", tvb(9, 2):uint()))
    show_epoch(report, tvb, 11)
    report:tell(fields.seen, tvb(15, 8), tvb(15, 8):uint64(), "Changes seen: " .. whole(tvb, 15))
    report:name(request.show)
    return report:close()
  end
  show_epoch(report, tvb, 10)
  if request.cancels then return show_cancelled_range(report, tvb, request) end
  if not request.write then
    show_number(report.item, tvb, 14)
    report:name(request.show .. ": " .. tvb(14, 2):uint())
    return report:close()
  end
  report.item:add(tvb(14, 8), "Due: " .. node_time(tvb, 14))
  local duration = tvb(22, 4):uint()
  report:tell(fields.duration, tvb(22, 4), duration, "Duration: " .. (duration == 0 and "for good" or duration .. " ms"))
  if holds(tvb, request.data, request.write) then
    report:range("write", request.write, message_at(tvb, request.data, request.write), "at " .. node_time(tvb, 14))
  end
  if #report.names == 0 then pinfo.cols.info:append(" | " .. request.show) end
  report:close()
end

local function show_bit(report, tvb, at)
  local name, address = time_tables[tvb(at, 1):uint()], tvb(at + 2, 2):uint()
  local value = tvb(at + 1, 1):uint() == 1 and "true" or "false"
  local found = covering.read[name] and covering.read[name][address]
  for _, covered in ipairs(found or {}) do
    local value_there = covered.point.count > 1 and string.format("[%d] %s", address - covered.from, value) or value
    report:add(covered.point, tvb(at, 12), value_there, "at " .. node_time(tvb, at + 4))
  end
  if not found then
    local text = string.format("%s %d: %s [at %s]", name or "table ?", address, value, node_time(tvb, at + 4))
    report.item:add(tvb(at, 12), text)
    report:name(text)
  end
end

local function show_outcome(report, tvb, at)
  local kind, reason = tvb(at + 1, 1):uint(), tvb(at, 1):uint()
  local outcome = ({ [3] = "driven", [4] = "cancelled", [5] = "not driven" })[kind] or "kind " .. kind
  local text = string.format("Scheduled output %d: %s", tvb(at + 2, 2):uint(), outcome)
  if reason > 0 then text = text .. ", " .. (reasons[reason] or "reason " .. reason) end
  text = text .. " [at " .. node_time(tvb, at + 4) .. "]"
  show_number(report:tell(fields.outcome, tvb(at, 12), outcome, text), tvb, at + 2)
  report:name(text)
end

local function show_changes(report, tvb)
  show_epoch(report, tvb, 9)
  report.item:add(tvb(13, 8), "Request arrived: " .. node_time(tvb, 13))
  report.item:add(tvb(21, 8), "Replied: " .. node_time(tvb, 21))
  report:tell(fields.newest, tvb(29, 8), tvb(29, 8):uint64(), "Newest change: " .. whole(tvb, 29))
  report:tell(fields.lost, tvb(37, 4), tvb(37, 4):uint(), "Changes lost: " .. tvb(37, 4):uint())
  if tvb(37, 4):uint() > 0 then report:name(tvb(37, 4):uint() .. " changes lost") end
  for i = 0, tvb(41, 1):uint() - 1 do
    local at = 42 + 12 * i
    if at + 12 > tvb:len() then return end
    if tvb(at + 1, 1):uint() < 2 then show_bit(report, tvb, at) else show_outcome(report, tvb, at) end
  end
end

local function show_time_reply(tvb, pinfo, tree, request)
  local code = tvb(7, 1):uint()
  if code >= 128 then
    local report = new_report(tvb, pinfo, tree, "refused")
    local remark = string.format("exception %02d", tvb(8, 1):uint())
    if request.write then
      report:range("write", request.write, nil, remark)
      return report:close()
    end
    report.item:append_text(" [" .. remark .. "]")
    report:name("refused [" .. remark .. "]")
    report:close()
  elseif code == wait_code and tvb:len() >= 42 then
    local report = new_report(tvb, pinfo, tree, "changes")
    show_changes(report, tvb)
    if #report.names == 0 and tvb(41, 1):uint() == 0 then report:name("no changes") end
    report:close()
  elseif code == schedule_code and tvb:len() >= 27 then
    local what, number = request.write and "scheduled" or "cancelled", tvb(9, 2):uint()
    local text = request.cancels and what .. ": " .. number or what .. " as number " .. number
    local report = new_report(tvb, pinfo, tree, text)
    if not request.cancels then show_number(report.item, tvb, 9) end
    report.item:add(tvb(11, 8), "Request arrived: " .. node_time(tvb, 11))
    report.item:add(tvb(19, 8), "Replied: " .. node_time(tvb, 19))
    report:name(text)
    report:close()
  end
end
