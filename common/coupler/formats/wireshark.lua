-- From here on the same for every map.

local proto = Proto(map.proto, "Points of " .. map.name)
local fields = {
  point = ProtoField.string(map.proto .. ".point", "Point"),
  value = ProtoField.string(map.proto .. ".value", "Value"),
}
proto.fields = fields
proto.prefs.port = Pref.uint("TCP port", map.port, "Where the device listens")

-- Numbers -------------------------------------------------------------------------------------------------------------

local function swapped(word) return word % 256 * 256 + math.floor(word / 256) end

local function bit_of(number, bit) return math.floor(number / 2 ^ bit) % 2 end

-- The registers of one value as words, the most significant first, bytes in place.
local function words_of(tvb, at, point, count)
  local words = {}
  for i = 1, count do
    local from = point.words_reversed and count - i or i - 1
    local word = tvb(at + 2 * from, 2):uint()
    words[i] = point.bytes_swapped and swapped(word) or word
  end
  return words
end

local function unsigned(words)
  local number = 0
  for _, word in ipairs(words) do number = number * 65536 + word end
  return number
end

local function signed(number, bits) return number >= 2 ^ (bits - 1) and number - 2 ^ bits or number end

-- IEEE 754: its value, and half of what is between it and the next.
local function float(words)
  local wide = #words == 4
  local mantissa_bits, bias, most = wide and 52 or 23, wide and 1023 or 127, wide and 2047 or 255
  local head = words[1] % 32768
  local exponent = math.floor(head / (wide and 16 or 128))
  local mantissa = head % (wide and 16 or 128)
  for i = 2, #words do mantissa = mantissa * 65536 + words[i] end
  local sign = words[1] >= 32768 and -1.0 or 1.0
  if exponent == most then return mantissa == 0 and sign * math.huge or 0 / 0, 0 end
  local scale = 2.0 ^ (math.max(exponent, 1) - bias - mantissa_bits)
  if exponent > 0 then mantissa = mantissa + 2.0 ^ mantissa_bits end
  return sign * mantissa * scale, scale / 2
end

-- The shortest text that reads back as the same number, with an exponent only where `coupler dump` has one.
local function shortest(number, tolerance)
  if number ~= number then return "nan" end
  if number == math.huge or number == -math.huge then return number > 0 and "inf" or "-inf" end
  for digits = 1, 17 do
    local text = string.format("%." .. digits - 1 .. "e", number)
    local off = math.abs(tonumber(text) - number)
    if off == 0 or off < tolerance or digits == 17 then
      local exponent = tonumber(text:match("e(.+)"))
      if exponent < -4 or exponent >= 16 then return text end
      return string.format("%." .. math.max(digits - 1 - exponent, 0) .. "f", tonumber(text))
    end
  end
end

local function long(words, is_signed)
  local class = is_signed and Int64 or UInt64
  return tostring(class.new(words[3] * 65536 + words[4], words[1] * 65536 + words[2]))
end

-- Texts ---------------------------------------------------------------------------------------------------------------

local function utf8_of_latin1(byte)
  if byte < 128 then return string.char(byte) end
  return string.char(192 + math.floor(byte / 64), 128 + byte % 64)
end

local function text_of(tvb, at, point)
  local text = {}
  for i = 0, point.length - 1 do
    local byte = tvb(at + (point.bytes_swapped and i - i % 2 + 1 - i % 2 or i), 1):uint()
    if byte == 0 then break end
    if point.encoding == "latin-1" then
      text[#text + 1] = utf8_of_latin1(byte)
    elseif point.encoding == "ascii" and byte > 127 then
      text[#text + 1] = "?"
    else
      text[#text + 1] = string.char(byte)
    end
  end
  return '"' .. table.concat(text) .. '"'
end

-- Values --------------------------------------------------------------------------------------------------------------

local function part_of(tvb, at, point)
  local word = tvb(at, 2):uint()
  if point.type == "BOOL" then
    return bit_of(point.bytes_swapped and swapped(word) or word, point.bit)
  end
  if point.high ~= point.bytes_swapped then return math.floor(word / 256) end
  return word % 256
end

-- Raw number, and its text.
local function number_of(tvb, at, point)
  local type, bits = point.type, point.bits
  if bits < 16 then
    local part = part_of(tvb, at, point)
    if type == "BOOL" then return part, part == 1 and "true" or "false" end
    if type == "BYTE" then return part, string.format("0x%02X", part) end
    if type == "CHAR" and part >= 32 and part < 127 then return part, part .. " '" .. string.char(part) .. "'" end
    if type == "SINT" then part = signed(part, 8) end
    return part, string.format("%.0f", part)
  end
  local words = words_of(tvb, at, point, bits / 16)
  if type == "REAL" or type == "LREAL" then
    local number, tolerance = float(words)
    return number, shortest(number, type == "REAL" and tolerance or 0)
  end
  local is_signed = type == "INT" or type == "DINT" or type == "LINT"
  local number = is_signed and signed(unsigned(words), bits) or unsigned(words)
  if type == "WORD" or type == "DWORD" or type == "LWORD" then
    local hex = {}
    for i, word in ipairs(words) do hex[i] = string.format("%04X", word) end
    return number, "0x" .. table.concat(hex)
  end
  return number, bits == 64 and long(words, is_signed) or string.format("%.0f", number)
end

local function register_value(tvb, at, point)
  if point.type == "STRING" then return text_of(tvb, at, point) end
  local number, text = number_of(tvb, at, point)
  if point.names and point.names[text] then return point.names[text] .. " (" .. text .. ")" end
  if not point.gain then return text end
  return string.format("%.12g", number * point.gain + point.offset)
end

-- Of a point that is there as a whole; `data` is where its table's part of the message begins.
local function value_of(message, point, at)
  local values = {}
  local element = point.size / point.count
  for i = 0, point.count - 1 do
    local place = at + i * element
    if message.bit then
      values[#values + 1] = message.bit(place) == 1 and "true" or "false"
    else
      values[#values + 1] = register_value(message.tvb, message.data + 2 * place, point)
    end
  end
  return point.count == 1 and values[1] or "[" .. table.concat(values, ", ") .. "]"
end

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

function Report:add(point, range, value, remark)
  local text = point.name .. (value and ": " .. value or "")
  if value and point.units then text = text .. " " .. point.units end
  if remark then text = text .. " [" .. remark .. "]" end
  self.names[#self.names + 1] = text
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

-- Requests and their replies ------------------------------------------------------------------------------------------

local waiting, answers = {}, {}  -- by connection and transaction id; by place in the capture

local function connection(client, client_port, server, server_port)
  return tostring(client) .. ":" .. client_port .. ">" .. tostring(server) .. ":" .. server_port
end

local function dissect_one(tvb, pinfo, tree)
  Dissector.get("mbtcp"):call(tvb, pinfo, tree)
  if tvb:len() < 9 then return tvb:len() end
  local unit = tvb(6, 1):uint()
  if unit ~= map.unit and unit ~= 0 and unit ~= 255 then return tvb:len() end
  local transaction = tvb(0, 2):uint()
  if pinfo.dst_port == pinfo.match then
    local request = request_of(tvb)
    if not request.read and not request.write then return tvb:len() end
    local key = connection(pinfo.src, pinfo.src_port, pinfo.dst, pinfo.dst_port) .. "#" .. transaction
    if not pinfo.visited then waiting[key] = request end
    show_request(tvb, pinfo, tree, request)
    return tvb:len()
  end
  local key = connection(pinfo.dst, pinfo.dst_port, pinfo.src, pinfo.src_port) .. "#" .. transaction
  local place = pinfo.number .. "/" .. key .. "/" .. tvb:offset()
  if not pinfo.visited then
    answers[place] = waiting[key]
    waiting[key] = nil
  end
  local request = answers[place]
  if request and tvb(7, 1):uint() % 128 == request.code then show_reply(tvb, pinfo, tree, request) end
  return tvb:len()
end

local function length_of(tvb, _, offset) return 6 + tvb(offset + 4, 2):uint() end

function proto.dissector(tvb, pinfo, tree)
  dissect_tcp_pdus(tvb, tree, 6, length_of, dissect_one)
  return tvb:len()
end

local registered
local ports = DissectorTable.get("tcp.port")
ports:add_for_decode_as(proto)
local function register()
  if registered == proto.prefs.port then return end
  if registered then ports:remove(registered, proto) end
  registered = proto.prefs.port
  ports:add(registered, proto)
end

function proto.prefs_changed() register() end

function proto.init()
  waiting, answers = {}, {}
  register()
end
