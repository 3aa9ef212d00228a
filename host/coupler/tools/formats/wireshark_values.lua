-- From here on the same for every map.

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

-- The characters of UTF-8 (RFC 3629).
local characters = {
  "^[\1-\127]", "^[\194-\223][\128-\191]", "^\224[\160-\191][\128-\191]", "^[\225-\236\238\239][\128-\191][\128-\191]",
  "^\237[\128-\159][\128-\191]", "^\240[\144-\191][\128-\191][\128-\191]",
  "^[\241-\243][\128-\191][\128-\191][\128-\191]", "^\244[\128-\143][\128-\191][\128-\191]",
}

-- Bytes that are not UTF-8 become "\xff", as in the clients.
local function escaped(text)
  local shown, at = {}, 1
  while at <= #text do
    local character
    for _, form in ipairs(characters) do character = character or text:match(form, at) end
    shown[#shown + 1] = character or string.format("\\x%02x", text:byte(at))
    at = at + #(character or " ")
  end
  return table.concat(shown)
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
  return '"' .. escaped(table.concat(text)) .. '"'
end

-- Values --------------------------------------------------------------------------------------------------------------

local function part_of(tvb, at, point)
  local word = tvb(at, 2):uint()
  if point.type == "BOOL" then
    return bit_of(point.bytes_swapped and swapped(word) or word, point.bit)
  end
  if point.width then
    word = point.bytes_swapped and swapped(word) or word
    return math.floor(word / 2 ^ point.bit) % 2 ^ point.width
  end
  if point.high ~= point.bytes_swapped then return math.floor(word / 256) end
  return word % 256
end

-- Raw number, and its text.
local function number_of(tvb, at, point)
  local type, bits = point.type, point.bits
  if bits < 16 or point.width then
    local part = part_of(tvb, at, point)
    if type == "BOOL" then return part, part == 1 and "true" or "false" end
    if type == "BYTE" then return part, string.format("0x%02X", part) end
    if type == "WORD" then return part, string.format("0x%04X", part) end
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
