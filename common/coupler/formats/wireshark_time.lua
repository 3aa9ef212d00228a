-- Function codes 65 and 66: changes, and outputs at a time ------------------------------------------------------------

local wait_code, schedule_code = 65, 66
local time_tables = { "coils", "discrete_inputs", "holding_registers", "input_registers" }
local reasons = {
  "its client cancelled it", "another write to the same point", "the watchdog expired", "outputs went to their safe state",
  "the node read a new map, lost or found a chip, or ended", "its connection ended",
  "the line or channel could not be driven", "the watchdog keeps outputs safe",
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
  if tvb(9, 1):uint() == 2 then return { code = code, show = "cancels a scheduled output" } end
  local name = size > 32 and time_tables[tvb(26, 1):uint()]
  if not name then return { code = code } end
  return { code = code, show = "schedules", data = 32,
           write = { table = name, start = tvb(27, 2):uint(), count = tvb(29, 2):uint() } }
end

local function show_time_request(tvb, pinfo, tree, request)
  local report = new_report(tvb, pinfo, tree, request.show)
  local item = report.item
  if request.code == wait_code then
    item:add(tvb(9, 2), string.format("Longest wait: %d ms", tvb(9, 2):uint()))
    item:add(tvb(11, 4), string.format("Epoch: 0x%08X", tvb(11, 4):uint()))
    item:add(tvb(15, 8), "Changes seen: " .. whole(tvb, 15))
    return
  end
  item:add(tvb(10, 4), string.format("Epoch: 0x%08X", tvb(10, 4):uint()))
  if not request.write then
    item:add(tvb(14, 2), "Number: " .. tvb(14, 2):uint())
    return
  end
  item:add(tvb(14, 8), "Due: " .. node_time(tvb, 14))
  local duration = tvb(22, 4):uint()
  item:add(tvb(22, 4), "Duration: " .. (duration == 0 and "for good" or duration .. " ms"))
  if holds(tvb, request.data, request.write) then
    report:range("write", request.write, message_at(tvb, request.data, request.write), "at " .. node_time(tvb, 14))
  end
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
    report.item:add(tvb(at, 12), string.format("%s %d: %s [at %s]", name or "table ?", address, value, node_time(tvb, at + 4)))
  end
end

local function show_outcome(report, tvb, at)
  local kind, reason = tvb(at + 1, 1):uint(), tvb(at, 1):uint()
  local outcomes = { [3] = "driven", [4] = "cancelled", [5] = "not driven" }
  local text = string.format("Scheduled output %d: %s", tvb(at + 2, 2):uint(), outcomes[kind] or "kind " .. kind)
  if reason > 0 then text = text .. ", " .. (reasons[reason] or "reason " .. reason) end
  report.item:add(tvb(at, 12), text .. " [at " .. node_time(tvb, at + 4) .. "]")
end

local function show_changes(report, tvb)
  local item = report.item
  item:add(tvb(9, 4), string.format("Epoch: 0x%08X", tvb(9, 4):uint()))
  item:add(tvb(13, 8), "Request arrived: " .. node_time(tvb, 13))
  item:add(tvb(21, 8), "Replied: " .. node_time(tvb, 21))
  item:add(tvb(29, 8), "Newest change: " .. whole(tvb, 29))
  item:add(tvb(37, 4), "Changes lost: " .. tvb(37, 4):uint())
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
  elseif code == wait_code and tvb:len() >= 42 then
    local report = new_report(tvb, pinfo, tree, "changes")
    show_changes(report, tvb)
    if #report.names > 0 then report:close() end
  elseif code == schedule_code and tvb:len() >= 27 then
    local what = request.write and "scheduled" or "cancelled"
    local report = new_report(tvb, pinfo, tree, what .. " as number " .. tvb(9, 2):uint())
    report.item:add(tvb(11, 8), "Request arrived: " .. node_time(tvb, 11))
    report.item:add(tvb(19, 8), "Replied: " .. node_time(tvb, 19))
  end
end
