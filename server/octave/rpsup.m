% SPDX-License-Identifier: Apache-2.0
classdef rpsup
  % Client of an RPSUP service, for Octave 7, with which it is tested, and MATLAB. Needs the program curl,
  % 7.71 or newer.
  %
  %   service = rpsup('http://127.0.0.1:8080');    % or rpsup(): RPSUP_URL and RPSUP_TOKEN of the environment
  %   id = service.submit('{"sweep": {"clearance_mm": [0, 0.25], "coupler": ["rigid", "flexible"]}}');
  %   service.wait(id);
  %   table = service.results(id);                 % a column a field; units end the names
  %   run = service.trajectory(table.job_id{1}, 'channels', {'slider_acceleration_m_s2'});
  %   plot(run.t_s, run.slider_acceleration_m_s2)
  %
  % A refused request is the error rpsup:refused with all faults in its message, a service that is not reached
  % rpsup:unreachable. A request that gets no answer is sent again; nothing is stored twice.

  properties (SetAccess = private)
    url
  end
  properties (Access = private)
    token
  end

  methods
    function self = rpsup(url, token)
      % rpsup(URL, TOKEN); both may be left out.
      if nargin < 1 || isempty(url), url = getenv('RPSUP_URL'); end
      if nargin < 2, token = getenv('RPSUP_TOKEN'); end
      if isempty(url), url = 'http://127.0.0.1:8080'; end
      self.url = regexprep(url, '/+$', '');
      self.token = token;
    end

    function id = submit(self, request)
      % ID of a new sweep. REQUEST is JSON text, or a struct whose axes of one value are cells: {0.25}.
      if ~ischar(request), request = jsonencode(request); end
      [~, unique] = fileparts(tempname());  % random numbers of MATLAB are the same in every session
      key = sprintf('%s-%.0f', unique, 1e9 * now());
      answer = self.ask('POST', '/v1/sweeps', {}, request, ['Idempotency-Key: ' key], '');
      id = answer.id;
    end

    function status = wait(self, id, timeout_s)
      % Status of a sweep or job once it has ended; after TIMEOUT_S it is the error rpsup:timeout.
      if nargin < 3, timeout_s = Inf; end
      start = tic;
      while true
        left_s = timeout_s - toc(start);
        prefer = sprintf('Prefer: wait=%d', max(1, min(20, floor(left_s))));
        status = self.ask('GET', self.path_of(id), {}, '', prefer, '');
        if any(strcmp(status.state, {'succeeded', 'failed', 'cancelled'})), return; end
        if toc(start) >= timeout_s
          error('rpsup:timeout', '%s is %s after %g s', id, status.state, timeout_s);
        end
        pause(0.2);
      end
    end

    function table = results(self, id, varargin)
      % Results of a sweep, a struct of columns: numbers as vectors with NaN for gaps, texts as cells.
      % Options by name: 'fields', {...}; 'order_by', {...}; 'limit', N; and any filter of the interface.
      rows = self.ask('GET', [self.path_of(id) '/results'], varargin, '', '', '');
      table = struct();
      if isempty(rows), return; end
      names = fieldnames(rows);
      for i = 1:numel(names)
        values = reshape({rows.(names{i})}, [], 1);
        gaps = cellfun(@isempty, values);
        if all(cellfun(@(value) isscalar(value) && (isnumeric(value) || islogical(value)), values(~gaps)))
          values(gaps) = {NaN};
          values = cellfun(@double, values);
        end
        table.(names{i}) = values;
      end
    end

    function run = trajectory(self, job, varargin)
      % Trajectory of a job, a struct of columns; t_s comes first.
      % Options by name: 'channels', {...}; 'from_s', S; 'to_s', S; 'points', N.
      answer = self.ask('GET', ['/v1/jobs/' job '/trajectory'], varargin, '', '', '');
      run = answer.columns;
    end

    function file = trajectories(self, id, file, varargin)
      % Writes the trajectories of all jobs of a sweep into a file that ends with .h5, .npz or .mat.
      % Options by name: 'channels', {...}; 'from_s', S; 'to_s', S.
      [~, ~, ending] = fileparts(file);
      if ~any(strcmp(ending, {'.h5', '.npz', '.mat'}))
        error('rpsup:file', '%s must end with .h5, .npz or .mat', file);
      end
      options = [{'format', ending(2:end)}, varargin];
      self.ask('GET', [self.path_of(id) '/trajectories'], options, '', '', file);
    end

    function status = cancel(self, id)
      % Cancels the jobs of a sweep that have not ended, or a job.
      status = self.ask('POST', [self.path_of(id) '/cancel'], {}, '', '', '');
    end

    function delete(self, id)
      % Deletes a sweep that has ended, or a job of no sweep.
      self.ask('DELETE', self.path_of(id), {}, '', '', '');
    end
  end

  methods (Access = private)
    function answer = ask(self, method, path, options, body, header, file)
      % JSON of an answer; FILE takes an answer that is no JSON. Everything is in a file for curl: no argument
      % of a program shows the token, and no shell reads a name.
      folder = tempname();
      mkdir(folder);
      cleanup = onCleanup(@() remove(folder));
      if isunix(), system(['chmod 700 "' folder '"']); end
      config = fullfile(folder, 'curl');
      got = fullfile(folder, 'answer');
      if ~isempty(file)
        got = [file '.part'];  % where there is room for it
        cleanup_part = onCleanup(@() remove_file(got));
      end
      if ~isempty(body), write_text(fullfile(folder, 'body'), body); end
      lines = {['request = "' method '"'], ['url = "' self.url path query_of(options) '"'], ...
               ['output = "' slashed(got) '"'], 'silent', 'show-error', 'write-out = "%{http_code}"', ...
               'retry = 4', 'retry-connrefused', 'retry-all-errors', 'retry-max-time = 30', ...
               'max-time = 3600', 'noproxy = "127.0.0.1,localhost"'};
      headers = {header};
      if ~isempty(body)
        lines{end + 1} = ['data-binary = "@' slashed(fullfile(folder, 'body')) '"'];
        headers{end + 1} = 'Content-Type: application/json';
      end
      if ~isempty(self.token), headers{end + 1} = ['Authorization: Bearer ' self.token]; end
      for i = 1:numel(headers)
        if ~isempty(headers{i}), lines{end + 1} = ['header = "' headers{i} '"']; end
      end
      write_text(config, sprintf('%s\n', lines{:}));
      command = ['curl --config "' config '" 2>&1'];
      if isunix(), command = ['LD_LIBRARY_PATH= ' command]; end  % MATLAB's libraries are not those of curl
      [code, said] = system(command);
      if code == 23, error('rpsup:file', '%s cannot be written: %s', got, strtrim(said)); end
      if code ~= 0, error('rpsup:unreachable', 'no answer from %s: %s', self.url, strtrim(said)); end
      status = str2double(said(max(1, end - 2):end));
      if status >= 400 || isnan(status), refuse(status, read_text(got)); end
      answer = [];
      if ~isempty(file)
        [moved, why] = movefile(got, file);
        if ~moved, error('rpsup:file', '%s cannot be written: %s', file, why); end
      elseif ~strcmp(method, 'DELETE')
        answer = jsondecode(read_text(got));
      end
    end
  end

  methods (Static, Access = private)
    function path = path_of(id)
      if strncmp(id, 'job_', 4), path = ['/v1/jobs/' id]; else, path = ['/v1/sweeps/' id]; end
    end
  end
end

function query = query_of(options)
  query = '';
  for i = 1:2:numel(options) - 1
    name = regexprep(options{i}, '^(from|to)_s$', '$1');
    value = options{i + 1};
    if iscell(value), value = strjoin(value, ','); end
    if ~ischar(value), value = sprintf('%.17g', value); end
    query = [query '&' name '=' escaped(value)];
  end
  if ~isempty(query), query(1) = '?'; end
end

function text = escaped(value)
  text = '';
  for byte = unicode2native(value, 'UTF-8')
    if any(byte == uint8('-._~,:abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789'))
      text = [text char(byte)];
    else
      text = [text sprintf('%%%02X', byte)];
    end
  end
end

function refuse(status, text)
  message = text;
  try
    problem = jsondecode(text);
    message = problem.detail;
    faults = cell(0, 1);
    if isfield(problem, 'errors')
      faults = arrayfun(@(fault) sprintf('%s: %s', fault.pointer, fault.detail), problem.errors(:), ...
                        'UniformOutput', false);
    end
    if numel(faults) > 1, message = strjoin(faults, sprintf('\n')); end
  catch  % no problem+json, such as that of a proxy
  end
  error('rpsup:refused', '%d: %s', status, message);
end

function write_text(name, text)
  file = fopen(name, 'w', 'n', 'UTF-8');
  if file < 0, error('rpsup:file', '%s cannot be written', name); end
  fwrite(file, unicode2native(text, 'UTF-8'));
  fclose(file);
end

function text = read_text(name)
  text = '';
  file = fopen(name, 'r');
  if file < 0, return; end  % an answer without a body
  text = native2unicode(fread(file, [1, Inf], '*uint8'), 'UTF-8');
  fclose(file);
end

function text = slashed(name)
  text = strrep(name, '\', '/');
end

function remove_file(file)
  if exist(file, 'file') == 2, delete(file); end
end

function remove(folder)
  names = {'curl', 'answer', 'body'};
  for i = 1:numel(names)
    name = fullfile(folder, names{i});
    if exist(name, 'file'), delete(name); end
  end
  rmdir(folder);
end
