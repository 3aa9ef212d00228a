-- Requests and their replies ------------------------------------------------------------------------------------------

local waiting, answers = {}, {}  -- by connection and transaction id; by place in the capture

local function connection(client, client_port, server, server_port)
  return tostring(client) .. ":" .. client_port .. ">" .. tostring(server) .. ":" .. server_port
end

local function dissect_points(tvb, pinfo, tree)
  local transaction = tvb(0, 2):uint()
  if pinfo.dst_port == pinfo.match then
    local request = request_of(tvb)
    if request.code >= wait_code then request = time_request_of(tvb) end
    if not request.read and not request.write and not request.show then return tvb:len() end
    local key = connection(pinfo.src, pinfo.src_port, pinfo.dst, pinfo.dst_port) .. "#" .. transaction
    if not pinfo.visited then waiting[key] = request end
    local show = request.show and show_time_request or show_request
    show(tvb, pinfo, tree, request)
    return tvb:len()
  end
  local key = connection(pinfo.dst, pinfo.dst_port, pinfo.src, pinfo.src_port) .. "#" .. transaction
  local place = pinfo.number .. "/" .. key .. "/" .. tvb:offset()
  if not pinfo.visited then
    answers[place] = waiting[key]
    waiting[key] = nil
  end
  local request = answers[place]
  if request and tvb(7, 1):uint() % 128 == request.code then
    local show = request.show and show_time_reply or show_reply
    show(tvb, pinfo, tree, request)
  end
  return tvb:len()
end

-- The maps -------------------------------------------------------------------------------------------------------------

-- All that Wireshark has loaded, each from a script of its own: it keeps one dissector for a port, which serves them all.
local maps = package.loaded.coupler_maps or { modbus = {} }
package.loaded.coupler_maps = maps
local ports = DissectorTable.get("tcp.port")

-- Remembers in maps.modbus whether the port is one of those in the settings of Wireshark's own dissector.
local function look_at(port)
  if maps.modbus[port] ~= nil then return end
  local there = ports:get_dissector(port)
  maps.modbus[port] = there ~= nil and tostring(there) == "Modbus/TCP"
end

-- Wireshark's own dissector tells requests from replies by the ports in its settings.
local function dissect_modbus(tvb, pinfo, tree)
  local server_port = pinfo.dst_port == pinfo.match and "dst_port" or "src_port"
  local port = pinfo[server_port]
  if not maps.modbus[port] then
    pinfo[server_port] = 502
    for each, is_modbus in pairs(maps.modbus) do
      if is_modbus then pinfo[server_port] = each end
    end
  end
  Dissector.get("mbtcp"):call(tvb, pinfo, tree)
  pinfo[server_port] = port
end

local this = { name = map.name, protocol = map.proto, unit = map.unit, prefs = proto.prefs, dissect = dissect_points }
table.insert(maps, this)

local function chosen(from, condition)
  local found = {}
  for _, each in ipairs(from) do
    if condition(each) then table.insert(found, each) end
  end
  return found
end

local function address_of(text)
  local known, address = pcall(text:find(":", 1, true) and Address.ipv6 or Address.ip, text)
  return known and address or nil
end

-- Those that a message may be about: one, if their ports, addresses and units tell them apart.
local function maps_of(server, port, unit)
  local here = chosen(maps, function(each) return each.prefs.port == port end)
  if #here == 0 then here = { this } end -- "Decode As"
  here = chosen(here, function(each) return each.unit == unit or unit == 0 or unit == 255 end)
  if #here < 2 then return here end
  local there = chosen(here, function(each) return each.prefs.address ~= "" and address_of(each.prefs.address) == server end)
  if #there == 0 then there = chosen(here, function(each) return each.prefs.address == "" end) end
  return there
end

local function dissect_one(tvb, pinfo, tree)
  -- A capture may end each packet early. Wireshark's dissector then gives up in a way that does not come back through Lua.
  if tvb:len() < tvb:reported_len() then
    Dissector.get("data"):call(tvb, pinfo, tree)
    return tvb:len()
  end
  dissect_modbus(tvb, pinfo, tree)
  if tvb:len() < 9 then return tvb:len() end
  local server = pinfo.dst_port == pinfo.match and pinfo.dst or pinfo.src
  local found = maps_of(server, pinfo.match, tvb(6, 1):uint())
  if #found == 1 then return found[1].dissect(tvb, pinfo, tree) end
  if #found > 1 then
    local names, options = {}, {}
    for _, each in ipairs(found) do
      table.insert(names, each.name)
      table.insert(options, "-o " .. each.protocol .. ".address:ADDRESS")
    end
    tree:add(proto, tvb()):set_text("several maps are loaded for this port: " .. table.concat(names, ", ") ..
      ". Say where their devices are: " .. table.concat(options, " "))
  end
  return tvb:len()
end

local function length_of(tvb, _, offset) return 6 + tvb(offset + 4, 2):uint() end

function proto.dissector(tvb, pinfo, tree)
  dissect_tcp_pdus(tvb, tree, 6, length_of, dissect_one)
  return tvb:len()
end

ports:add_for_decode_as(proto)

function this.leave_port()
  if this.port then ports:remove(this.port, proto) end
end

function this.take_port()
  this.port = proto.prefs.port
  look_at(this.port)
  ports:add(this.port, proto)
end

-- One that leaves its port takes it from the others, too.
local function register()
  if this.port == proto.prefs.port then return end
  look_at(502)
  for _, each in ipairs(maps) do each.leave_port() end
  for _, each in ipairs(maps) do each.take_port() end
end

function proto.prefs_changed() register() end

function proto.init()
  waiting, answers = {}, {}
  register()
end
