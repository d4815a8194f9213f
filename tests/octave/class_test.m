% SPDX-License-Identifier: Apache-2.0
% Uses every verb of the class rpsup. class_test.sh starts what it speaks to.
1;
function expect(is_true, what)
  if ~is_true, error('failed: %s', what); end
end
function [identifier, message] = error_of(call)
  identifier = ''; message = '';
  try
    call();
  catch problem
    identifier = problem.identifier; message = problem.message;
  end
end

addpath(getenv('CLASS'));
service = rpsup(getenv('URL'), getenv('TOKEN'));
expect(strcmp(service.url, getenv('URL')), 'the address');

request = struct('name', 'größer als 0 "µm" \', 'parameters', struct('duration_s', 0.3, 'run_up_s', 0.1), ...
                 'sweep', struct('clearance_mm', [0, 0.25], 'coupler', {{'rigid', 'flexible'}}));
id = service.submit(request);
status = service.wait(id);
expect(strcmp(status.state, 'succeeded') && status.counts.succeeded == 4, 'the end of the sweep');
expect(strcmp(status.name, request.name), 'a name with signs that shells and texts quote');

table = service.results(id);
expect(isequal(table.clearance_mm, [0; 0; 0.25; 0.25]), 'a column of numbers');
expect(isequal(table.coupler, {'rigid'; 'flexible'; 'rigid'; 'flexible'}), 'a column of texts');
expect(isequal(isnan(table.peak_contact_force_n), table.clearance_mm == 0), 'a column with gaps');
expect(all(isnan(table.mean_crank_velocity_rad_s)), 'a column of gaps');
some = service.results(id, 'fields', {'clearance_mm', 'job_id'}, 'order_by', {'-clearance_mm'}, ...
                       'coupler', 'rigid', 'limit', 1);
expect(isequal(fieldnames(some), {'clearance_mm'; 'job_id'}), 'fields');
expect(isequal(some.clearance_mm, 0.25), 'order, filter, limit');
expect(strcmp(some.job_id{1}, table.job_id{3}), 'the same job');
expect(isempty(fieldnames(service.results(id, 'state', 'failed'))), 'no rows');

channels = {'slider_acceleration_m_s2', 'journal_x_mm'};
run = service.trajectory(some.job_id{1}, 'channels', channels, 'from_s', 0.1, 'to_s', 0.2);
expect(isequal(fieldnames(run), {'t_s'; 'slider_acceleration_m_s2'; 'journal_x_mm'}), 'the channels');
expect(all(run.t_s >= 0.1 & run.t_s <= 0.2) && all(diff(run.t_s) > 0) && numel(run.t_s) > 50, 'the times');
expect(numel(run.journal_x_mm) == numel(run.t_s), 'a column of a trajectory');
thin = service.trajectory(some.job_id{1}, 'channels', {'journal_x_mm'}, 'points', 20);
expect(numel(thin.t_s) <= 20, 'the number of points');

% Faults are all named, and text is taken as text.
wrong = '{"parameters": {"clearence_mm": 0.1, "restitution": 1.5}}';
[identifier, message] = error_of(@() service.submit(wrong));
expect(strcmp(identifier, 'rpsup:refused'), 'the identifier of a refusal');
for part = {'422', 'clearance_mm?', '[0, 1]'}
  expect(~isempty(strfind(message, part{1})), message);
end
[identifier, message] = error_of(@() service.trajectory('job_none'));
expect(strcmp(identifier, 'rpsup:refused') && ~isempty(strfind(message, '404')), message);
[identifier, message] = error_of(@() rpsup(getenv('URL'), 'wrong').results(id));
expect(strcmp(identifier, 'rpsup:refused') && ~isempty(strfind(message, '401')), message);
expect(strcmp(error_of(@() service.trajectories(id, 'study.txt')), 'rpsup:file'), 'a name of a file');

long = service.submit('{"parameters": {"duration_s": 600}, "sweep": {"crank_velocity_rad_s": [5, 6]}}');
expect(strcmp(error_of(@() service.wait(long, 0.5)), 'rpsup:timeout'), 'a timeout');
service.cancel(long);
status = service.wait(long);
expect(strcmp(status.state, 'cancelled'), 'a cancelled sweep');
service.delete(long);
expect(strcmp(error_of(@() service.wait(long)), 'rpsup:refused'), 'a deleted sweep');

% A server that fails: the request is sent again, the file is written.
failing = rpsup([getenv('FAILING') '/'], '');
expect(strcmp(failing.submit(request), 'swp_1'), 'a submission that was sent again');
channels = {'journal_x_mm', 'journal_y_mm'};
file = failing.trajectories('swp_1', 'study.npz', 'channels', channels, 'from_s', 0.5, 'to_s', 2);
expect(strcmp(file, 'study.npz') && exist(file, 'file') == 2, 'a file');
disp('all of the class works');
