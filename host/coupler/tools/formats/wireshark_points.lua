-- Points in messages -------------------------------------------------------------------------------------------------

local proto = Proto(map.proto, "Points of " .. map.name)
local fields = {
  point = ProtoField.string(map.proto .. ".point", "Point"),
  value = ProtoField.string(map.proto .. ".value", "Value"),
  -- Of function codes 65 and 66.
  longest_wait = ProtoField.uint16(map.proto .. ".longest_wait", "Longest wait"),
  epoch = ProtoField.uint32(map.proto .. ".epoch", "Epoch", base.HEX),
  seen = ProtoField.uint64(map.proto .. ".seen", "Changes seen"),
  newest = ProtoField.uint64(map.proto .. ".newest", "Newest change"),
  lost = ProtoField.uint32(map.proto .. ".lost", "Changes lost"),
  number = ProtoField.uint16(map.proto .. ".number", "Number"),
  duration = ProtoField.uint32(map.proto .. ".duration", "Duration"),
  outcome = ProtoField.string(map.proto .. ".outcome", "Outcome"),
}
proto.fields = fields
proto.prefs.port = Pref.uint("TCP port", map.port, "Where the device listens")
proto.prefs.address = Pref.string("IP address", map.address,
  "Where the device is; it counts if several maps have the same port")

-- Which points cover an address, by table, for reads and for writes. ------------------------------------------------

local covering = { read = {}, write = {} }
local function cover(way, point, from)
  local addresses = covering[way][point.table] or {}
  covering[way][point.table] = addresses
  for address = from, from + point.size - 1 do
    addresses[address] = addresses[address] or {}
    table.insert(addresses[address], { point = point, from = from })
  end
end
for _, point in ipairs(map.points) do
  if point.readable then cover("read", point, point.read_from or point.address) end
  if point.writable then cover("write", point, point.address) end
end

-- Calls show(point, where it begins behind the first address) for every point that has a part in the range.
local function each_point(way, range, show)
  local addresses = covering[way][range.table] or {}
  for address = range.start, range.start + range.count - 1 do
    for _, covered in ipairs(addresses[address] or {}) do
      if covered.from == address or address == range.start then show(covered.point, covered.from - range.start) end
    end
  end
end

-- The tree ------------------------------------------------------------------------------------------------------------

local Report = {}
Report.__index = Report

local function new_report(tvb, pinfo, tree, what)
  local item = tree:add(proto, tvb())
  item:set_text(map.name .. ": " .. what)
  return setmetatable({ item = item, tvb = tvb, pinfo = pinfo, names = {} }, Report)
end

-- What is no point: text for people, value for filters. Returns its item.
function Report:tell(field, range, value, text) return self.item:add(field, range, value):set_text(text) end

-- In the information column.
function Report:name(text) self.names[#self.names + 1] = text end

function Report:add(point, range, value, remark)
  local text = point.name .. (value and ": " .. value or "")
  if value and point.units then text = text .. " " .. point.units end
  if remark then text = text .. " [" .. remark .. "]" end
  self:name(text)
  if point.description then text = text .. " (" .. point.description .. ")" end
  local item = self.item:add(fields.point, range, point.name)
  item:set_text(text)
  if value then item:add(fields.value, range, value) end
end

-- message: { tvb, data = offset of the first value, bit = function(i) for tables of bits }; nil: names only.
function Report:range(way, range, message, remark)
  each_point(way, range, function(point, at)
    if not message then return self:add(point, self.tvb(), nil, remark) end
    if at < 0 or at + point.size > range.count then
      return self:add(point, self.tvb(), nil, "only a part of it is in this message")
    end
    local bytes
    if message.bit then
      local first = math.floor(at / 8)
      bytes = self.tvb(message.data + first, math.floor((at + point.size - 1) / 8) - first + 1)
    else
      bytes = self.tvb(message.data + 2 * at, 2 * point.size)
    end
    self:add(point, bytes, value_of(message, point, at), remark)
  end)
end

function Report:close()
  local shown = {}
  for i = 1, math.min(#self.names, 4) do shown[i] = self.names[i] end
  if #self.names > 4 then shown[5] = "…" end
  if #self.names > 0 then self.pinfo.cols.info:append(" | " .. table.concat(shown, ", ")) end
  if #self.names == 0 then self.item:append_text(" (no point of the map)") end
end

-- Messages ------------------------------------------------------------------------------------------------------------

local bit_tables = { coils = true, discrete_inputs = true }
local read_tables = { "coils", "discrete_inputs", "holding_registers", "input_registers" }

local function message_at(tvb, data, range)
  local message = { tvb = tvb, data = data }
  if bit_tables[range.table] then
    message.bit = function(i) return bit_of(tvb(data + math.floor(i / 8), 1):uint(), i % 8) end
  end
  return message
end

-- Are the values of the whole range there?
local function holds(tvb, data, range)
  local bytes = bit_tables[range.table] and math.ceil(range.count / 8) or 2 * range.count
  return data + bytes <= tvb:len()
end

-- What a request asks for: { code, read = range, write = range, data = offset of the values to write }. The function
-- code is at 7, behind the MBAP header.
local function request_of(tvb)
  local code = tvb(7, 1):uint()
  local function word(at) return tvb(at, 2):uint() end
  local function range(name, at, count) return { table = name, start = word(at), count = count } end
  local long_enough = { [5] = 12, [6] = 12, [15] = 13, [16] = 13, [22] = 14, [23] = 17 }
  if tvb:len() < (long_enough[code] or 12) then return { code = code } end
  if code >= 1 and code <= 4 then return { code = code, read = range(read_tables[code], 8, word(10)) } end
  if code == 5 then return { code = code, write = range("coils", 8, 1), data = 10 } end
  if code == 6 then return { code = code, write = range("holding_registers", 8, 1), data = 10 } end
  if code == 15 then return { code = code, write = range("coils", 8, word(10)), data = 13 } end
  if code == 16 then return { code = code, write = range("holding_registers", 8, word(10)), data = 13 } end
  if code == 22 then return { code = code, write = range("holding_registers", 8, 1), mask = { word(10), word(12) } } end
  if code == 23 then
    return { code = code, read = range("holding_registers", 8, word(10)), data = 17,
             write = range("holding_registers", 12, word(14)) }
  end
  return { code = code }
end

local function show_write(report, tvb, request)
  if request.mask then
    local mask = string.format("and 0x%04X, or 0x%04X", request.mask[1], request.mask[2])
    report:range("write", request.write, nil, mask)
  elseif request.code == 5 then
    -- FF00 is on: the bit is the first byte's.
    local on = tvb(request.data, 1):uint() == 255 and 1 or 0
    report:range("write", request.write, { tvb = tvb, data = request.data, bit = function() return on end })
  elseif holds(tvb, request.data, request.write) then
    report:range("write", request.write, message_at(tvb, request.data, request.write))
  end
end

local function show_request(tvb, pinfo, tree, request)
  local what = request.write and (request.read and "writes and reads" or "writes") or "reads"
  local report = new_report(tvb, pinfo, tree, what)
  if request.write then show_write(report, tvb, request) end
  if request.read then report:range("read", request.read, nil) end
  report:close()
end

local function show_reply(tvb, pinfo, tree, request)
  local code = tvb(7, 1):uint()
  if code >= 128 then
    local report = new_report(tvb, pinfo, tree, "refused")
    local remark = string.format("exception %02d", tvb:len() > 8 and tvb(8, 1):uint() or 0)
    if request.write then report:range("write", request.write, nil, remark) end
    if request.read then report:range("read", request.read, nil, remark) end
    return report:close()
  end
  local report = new_report(tvb, pinfo, tree, request.read and "values" or "written")
  if request.read and holds(tvb, 9, request.read) then
    report:range("read", request.read, message_at(tvb, 9, request.read))
  elseif request.write and (code == 5 or code == 6) and tvb:len() >= 12 then
    show_write(report, tvb, request)
  elseif request.write then
    report:range("write", request.write, nil)
  end
  report:close()
end
